#include "run_folder/run_folder.h"

#include <gtest/gtest.h>

#include <cmath>
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
  const RunFolder run = read_run_folder(scratch.path());
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
    const RunResult result = read_run_folder(scratch.path()).result;
    EXPECT_FALSE(result.modulus || result.linear_limit || result.peak_strain || result.band || result.beads)
        << text;
    viz::RenderSummary summary;
    summary.run.result = result;
    EXPECT_NE(viz::compression_summary(summary).find("No shear band"), std::string::npos);
  }
}

TEST(RunFolder, ANumberThatNoRunCanHaveIsNamed) {
  const test::ScratchFolder scratch;
  for (const auto& [field, value] :
       std::vector<std::pair<std::string, std::string>>{{"beads", "-1"},
                                                        {"beads", "1e300"},
                                                        {"bonds", "2.5"},
                                                        {"final_strain", "true"},
                                                        {"linear_modulus_pa/value", "1e300"},
                                                        {"linear_modulus_pa/sigma", "-1"},
                                                        {"coordination/bridges_per_interior_bead", "[7]"},
                                                        {"specimen/height_um", "0"},
                                                        {"work_balance/relative_error", "\"small\""}}) {
    nlohmann::json result = {{"beads", 12}, {"final_strain", 0.1}};
    result[nlohmann::json::json_pointer("/" + field)] = nlohmann::json::parse(value);
    write_text(scratch / "result.json", result.dump());
    try {
      read_result(scratch / "result.json");
      ADD_FAILURE() << field << " = " << value;
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find("result.json: " + field + ": found"), std::string::npos)
          << error.what();
    }
  }
}

TEST(RunFolder, EveryColumnOfACurveComesBackAndEmptyCellsWhereTheyMayBe) {
  const test::ScratchFolder scratch;
  std::vector<CurveRow> rows(2);
  std::vector<double CurveRow::*> all;
  double value = 1.0;
  for (const auto& column : curve_columns()) {
    all.push_back(column.field);
    for (auto& row : rows) row.*column.field = value++;
    if (column.may_be_empty) rows[1].*column.field = std::nan("");
  }
  write_curve(scratch / "curve.csv", rows, {});
  const auto read = read_curve(scratch / "curve.csv", all);
  ASSERT_EQ(read.size(), rows.size());
  for (const auto& column : curve_columns()) {
    EXPECT_EQ(read[0].*column.field, rows[0].*column.field) << column.name;
    EXPECT_EQ(std::isnan(read[1].*column.field), column.may_be_empty) << column.name;
  }
  EXPECT_EQ(read_curve(scratch / "curve.csv", {&CurveRow::strain})[0].stress, 0.0);  // not asked for

  rows[0].stress = std::nan("");
  write_curve(scratch / "curve.csv", rows, {});
  EXPECT_THROW(read_curve(scratch / "curve.csv", {&CurveRow::stress}), BadInput);
}

TEST(RunFolder, BaseOfAFrameComesBack) {
  const test::ScratchFolder scratch;
  RunFrame frame;
  frame.strain = 0.02, frame.stress = 3e4, frame.platen_top = 1e-3, frame.specimen_diameter = 2e-3;
  frame.ids = {7, 9};
  frame.position = {Vec3(1e-4, 2e-4, 3e-4), Vec3(0.0, 0.0, 1e-4)};
  frame.displacement = {Vec3(1e-6, 0.0, 0.0), Vec3(0.0, 0.0, 2e-6)};
  frame.diameter = {2e-4, 2.1e-4};
  frame.pairs = {{0, 1}};
  frame.lines = {RunFrame::Line::broken};
  write_polydata(scratch / "frame_0000.vtp", table_of(frame));
  const RunFrame read = run_frame(read_polydata(scratch / "frame_0000.vtp"), "frame");
  EXPECT_EQ(read.ids, frame.ids);
  EXPECT_EQ(read.lines, frame.lines);
  EXPECT_EQ(read.pairs, frame.pairs);
  EXPECT_NEAR((read.position[0] - frame.position[0]).norm(), 0.0, 1e-12);
  EXPECT_NEAR((read.displacement[1] - frame.displacement[1]).norm(), 0.0, 1e-12);
  EXPECT_NEAR(read.diameter[1], frame.diameter[1], 1e-12);
  EXPECT_NEAR(read.specimen_diameter, frame.specimen_diameter, 1e-12);
  EXPECT_EQ(read.strain, frame.strain);
  PolyTable without = table_of(frame);
  without.number_fields.erase("strain");
  EXPECT_THROW(run_frame(without, "frame"), BadInput);
}

TEST(RunFolder, RealisationsComeInOrder) {
  const test::ScratchFolder scratch;
  for (const char* name : {"realisation_10", "realisation_02", "realisation_01", "logs"})
    make_folder(scratch / name);
  const auto found = realisations(scratch.path());
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
