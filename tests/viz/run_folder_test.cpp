#include "viz/run_folder.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "planted_run.h"
#include "scratch.h"
#include "viz/frame.h"
#include "viz/render_run.h"

namespace pendular {
namespace {

test::PlantedRun small() {
  test::PlantedRun planted;
  planted.specimen_diameter = 1.2e-3;
  planted.specimen_height = 1.0e-3;
  planted.frames = 2;
  return planted;
}

TEST(RunFolder, ReadsWhatWasPlanted) {
  const test::ScratchFolder scratch;
  const test::PlantedRun planted = small();
  test::write_planted_run(scratch.path(), planted);
  const viz::RunFolder run = viz::read_run_folder(scratch.path());
  ASSERT_TRUE(run.result.band);
  EXPECT_NEAR(run.result.band->angle_to_axis(), planted.band_angle, 1e-12);
  EXPECT_NEAR((run.result.band->normal - planted.normal()).norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(*run.result.modulus, planted.modulus);
  EXPECT_DOUBLE_EQ(run.result.toe, planted.toe);
  EXPECT_EQ(run.frames.size(), 2u);
  const viz::Frame last = viz::read_frame(run.frames.back());
  EXPECT_NEAR(last.specimen_diameter, planted.specimen_diameter, 1e-12);
  EXPECT_EQ(static_cast<std::int64_t>(last.position.size()), *run.result.beads);
}

TEST(RunFolder, WhatAResultDoesNotSayIsEmpty) {
  const test::ScratchFolder scratch;
  test::write_planted_run(scratch.path(), small());
  for (const char* text :
       {"{}", R"({"linear_modulus_pa": null, "fit": null, "peak": null, "linear_limit_strain": null,
                                    "shear_band": {"found": false, "normal": [0,0,1], "point_um": [0,0,0]}})"}) {
    write_text(scratch / "result.json", text);
    const viz::RunResult result = viz::read_run_folder(scratch.path()).result;
    EXPECT_FALSE(result.modulus || result.linear_limit || result.peak_strain || result.band || result.beads)
        << text;
    viz::RenderSummary summary;
    summary.run.result = result;
    EXPECT_NE(viz::compression_summary(summary).find("No shear band"), std::string::npos);
  }
}

TEST(RunFolder, RealisationsComeInOrder) {
  const test::ScratchFolder scratch;
  for (const char* name : {"realisation_10", "realisation_02", "realisation_01", "logs"})
    make_folder(scratch / name);
  const auto found = viz::realisations(scratch.path());
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found.front().filename(), "realisation_01");
  EXPECT_EQ(found.back().filename(), "realisation_10");
}

TEST(RunFolder, BadInputIsOneLineThatNamesThePlace) {
  const test::ScratchFolder scratch;
  struct Case {
    std::string spoiled;  ///< what the message must name
    std::function<void(const fs::path&)> spoil;
  };
  const std::vector<Case> cases = {
      {"run", [](const fs::path& run) { fs::remove_all(run); }},
      {"run", [](const fs::path& run) { fs::remove(run / "curve.csv"); }},
      {"curve.csv", [](const fs::path& run) { write_text(run / "curve.csv", "strain,stress_pa\n"); }},
      {"curve.csv", [](const fs::path& run) { write_text(run / "curve.csv", ""); }},
      {"curve.csv", [](const fs::path& run) { write_text(run / "curve.csv", "strain,force\n0,1\n1,2\n"); }},
      {"curve.csv",
       [](const fs::path& run) { write_text(run / "curve.csv", "strain,stress_pa\n0,one\n1,2\n"); }},
      {"result.json", [](const fs::path& run) { fs::remove(run / "result.json"); }},
      {"result.json", [](const fs::path& run) { write_text(run / "result.json", "{\"peak\": "); }},
      {"result.json",
       [](const fs::path& run) { write_text(run / "result.json", R"({"linear_limit_strain": "much"})"); }},
      {"result.json",
       [](const fs::path& run) {
         write_text(run / "result.json",
                    R"({"shear_band": {"found": true, "normal": [0,0,0], "point_um": [0,0,0]}})");
       }},
      {"frames", [](const fs::path& run) { fs::remove_all(run / "frames"); }},
      {"frame_0001.vtp", [](const fs::path& run) { fs::resize_file(run / "frames/frame_0001.vtp", 900); }},
      {"frame_0000.vtp", [](const fs::path& run) { write_text(run / "frames/frame_0000.vtp", "not xml"); }}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const fs::path run = scratch / "run";
    fs::remove_all(run);
    test::write_planted_run(run, small());
    cases[k].spoil(run);
    try {
      viz::render_run(run, scratch / "out");
      ADD_FAILURE() << "case " << k << " was accepted";
    } catch (const BadInput& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(cases[k].spoiled), std::string::npos) << "case " << k << ": " << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << "case " << k << ": " << message;
    }
    EXPECT_FALSE(fs::exists(scratch / "out")) << "case " << k;
  }
}

}  // namespace
}  // namespace pendular
