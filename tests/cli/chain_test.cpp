#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/files.h"
#include "packing/comparison.h"
#include "packing/tables.h"
#include "packing/vtp.h"
#include "picture.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::content;
using test::ScratchFolder;
using test::shared_data;
using test::shell;

nlohmann::json json_of(const fs::path& path) {
  return nlohmann::json::parse(content(path));
}

void expect_done(const test::Outcome& outcome) {
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
}

TEST(Chain, FromTomogramToPictures) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample("max_strain = 0.11\nframes = 5\n"));
  expect_done(shell(folder.path(), "$P phantom s.toml -o v.mha --truth truth.vtp"));
  expect_done(shell(folder.path(), "$P segment v.mha -o beads.csv --bridges bridges.csv"));
  expect_done(shell(folder.path(), "$P pack beads.csv --sample s.toml -o packing.vtp"));
  expect_done(shell(folder.path(), "$P compress packing.vtp --sample s.toml -o run"));
  expect_done(shell(folder.path(), "$P render run -o pictures --no-film"));

  const auto beads =
      compare_beads(read_packing(folder / "truth.vtp").beads, read_beads(folder / "beads.csv"));
  EXPECT_GE(static_cast<double>(beads.matched), 0.995 * static_cast<double>(beads.truth));
  EXPECT_EQ(beads.invented, 0u);
  EXPECT_LT(beads.centre_rms.maxCoeff(), 0.1 * 10e-6) << "a tenth of a voxel";

  // The specimen that was scanned, compressed as it is, is as stiff and as strong as the one that was found.
  write_text(folder / "true.toml",
             test::small_sample("max_strain = 0.11\nframes = 0\n", "[beads]\ndiameters = \"measured\"\n"));
  expect_done(shell(folder.path(), "$P compress truth.vtp --sample true.toml -o true"));
  const auto result = json_of(folder / "run" / "result.json"),
             truth = json_of(folder / "true" / "result.json");
  const auto over_truth = [&](const char* outer, const char* inner) {
    return result[outer][inner].get<double>() / truth[outer][inner].get<double>();
  };
  EXPECT_NEAR(over_truth("linear_modulus_pa", "value"), 1.0, 0.03);
  EXPECT_NEAR(over_truth("peak", "stress_pa"), 1.0, 0.08);
  EXPECT_NEAR(over_truth("coordination", "bridges_per_interior_bead"), 1.0, 0.01);
  EXPECT_NEAR(result["broken_bonds"].get<double>() / truth["broken_bonds"].get<double>(), 1.0, 0.15);
  EXPECT_LT(std::fabs(result["work_balance"]["relative_error"].get<double>()), 0.02);
  EXPECT_EQ(result["beads"].get<std::size_t>(), beads.found);
  EXPECT_TRUE(fs::exists(folder / "pictures" / "stress_strain.png"));
  const double drawn = test::drawn_share(test::picture(folder / "pictures" / "shear_strain_end.png"));
  EXPECT_GT(drawn, 0.15);
  EXPECT_LT(drawn, 0.9);
}

TEST(Chain, QuasiStaticStressIsTheSameOnBothPlatens) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample("max_strain = 0.03\nframes = 1\nspeed = 2e-5\n"));
  expect_done(
      shell(folder.path(),
            "$P pack --generate --sample s.toml -o p.vtp && $P compress p.vtp --sample s.toml -o run"));
  std::istringstream rows(content(folder / "run" / "curve.csv"));
  std::string row, last;
  while (std::getline(rows, row)) last = row;
  double strain = 0, top = 0, bottom = 0;
  ASSERT_EQ(std::sscanf(last.c_str(), "%lf,%lf,%lf", &strain, &top, &bottom), 3) << last;
  EXPECT_NEAR(top, bottom, 0.03 * top);
}

TEST(Chain, SameBytesForAnyThreadCount) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  for (const std::string t : {"1", "2"}) {
    const std::string c = "mkdir " + t + " && $P phantom s.toml -o " + t + "/v.mha --threads " + t +
                          " && $P pack --generate --sample s.toml -o " + t + "/p.vtp --threads " + t;
    expect_done(shell(folder.path(), c));
    expect_done(shell(folder.path(), "$P segment 1/v.mha -o " + t + "/beads.csv --threads " + t));
    expect_done(shell(folder.path(), "$P compress 1/p.vtp --sample s.toml -o " + t + "/run --threads " + t));
  }
  for (const char* file : {"v.mha", "p.vtp", "beads.csv", "run/curve.csv", "run/events.csv",
                           "run/frames/frame_0002.vtp", "run/checkpoint"})
    EXPECT_EQ(sha256_of(folder / "1" / file), sha256_of(folder / "2" / file)) << file;
}

TEST(Chain, RealisationsDifferAndAreSummed) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample("max_strain = 0.06\nframes = 1\n"));
  expect_done(shell(folder.path(),
                    "$P pack --generate --sample s.toml -o p.vtp && $P compress p.vtp --sample s.toml -o run "
                    "--realisations 2"));
  const auto result = json_of(folder / "run" / "result.json");
  const auto values = result["linear_modulus_pa"]["values"];
  ASSERT_EQ(values.size(), 2u);
  EXPECT_NE(values[0], values[1]);
  EXPECT_NEAR(result["linear_modulus_pa"]["mean"].get<double>(),
              0.5 * (values[0].get<double>() + values[1].get<double>()), 1.0);
}

TEST(Chain, FinneyPackComesBackAndCompresses) {
  const auto data = shared_data("finney/FinneyPack.txt");
  if (!data) GTEST_SKIP() << "the trial data is absent: finney/FinneyPack.txt";
  ScratchFolder folder;
  write_text(
      folder / "s.toml",
      test::sample_file("[beads]\ndiameter_um = 200\ndiameters = \"measured\"\n"
                        "[bridges]\nnormal_stiffness_n_per_m = 5760\ntangential_stiffness_n_per_m = 325\n"
                        "[specimen]\ndiameter_um = 3800\nheight_um = 3800\n"
                        "[phantom]\nvoxel_um = 10\nwall_thickness_um = 0\npiston_contrast = 0\n"
                        "[compression]\nmax_strain = 0.003\nframes = 1\n"));
  expect_done(
      shell(folder.path(), "$P convert '" + data->string() + "' finney.vtp --from xyz --diameter-um 200"));
  expect_done(shell(folder.path(), "$P phantom s.toml --packing finney.vtp -o v.mha"));
  expect_done(shell(folder.path(), "$P segment v.mha -o beads.csv"));
  expect_done(shell(folder.path(), "$P pack beads.csv --sample s.toml -o p.vtp"));
  expect_done(shell(folder.path(), "$P compress p.vtp --sample s.toml -o run"));

  const auto beads =
      compare_beads(read_packing(folder / "finney.vtp").beads, read_beads(folder / "beads.csv"));
  EXPECT_EQ(beads.truth, 4021u);
  EXPECT_EQ(beads.matched, 4021u);
  EXPECT_EQ(beads.invented, 0u);
  EXPECT_LT(beads.centre_rms.maxCoeff(), 0.05 * 10e-6) << "a twentieth of a voxel";
  EXPECT_LT(std::fabs(beads.diameter_bias), 0.05 * 10e-6);
  // The platens' work is the area under the curve.
  const CsvTable curve = read_csv(folder / "run" / "curve.csv", {"strain", "stress_bottom_pa"});
  const auto strain = curve.numbers("strain"), bottom = curve.numbers("stress_bottom_pa");
  double area = 0.0, begin = 0.0;  // strain and stress are means over a row's interval
  for (std::size_t k = 0; k < strain.size(); ++k) {
    const double end = 2.0 * strain[k] - begin;
    area += bottom[k] * (end - begin);
    begin = end;
  }
  const auto result = json_of(folder / "run" / "result.json");
  const double volume =
      1e-12 * result["specimen"]["height_um"].get<double>() * result["specimen"]["section_mm2"].get<double>();
  const double work = result["work_balance"]["platen_j"];
  EXPECT_NEAR(work / (area * volume), 1.0, 0.002);
}

}  // namespace
}  // namespace pendular
