#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "blind/engine_run.h"
#include "blind/plan.h"
#include "dem_core/bond_bodies.h"
#include "micromechanics/stiffness.h"
#include "packing/bridges.h"
#include "places.h"
#include "scratch.h"
#include "small_split.h"

namespace pendular::blind {
namespace {

using nlohmann::json;
using pendular::test::ScratchFolder;

/// Three beads in a row, the first two bridged and the last two.
Packing three_beads() {
  Packing packing;
  for (int k = 0; k < 3; ++k) {
    Bead bead;
    bead.id = k;
    bead.centre = Vec3(1e-7 * k, 1.0 / 3e6, 2.03e-4 * k);
    bead.diameter = 2.009e-4 + 1e-7 / 3 * k;
    packing.beads.push_back(bead);
  }
  packing.specimen = {4e-4, 6e-4, 1e-5, 0.0, 0.0};
  packing.bridges = candidate_bridges(packing.beads, 13e-6);
  return packing;
}

Sample with_effect() {
  Sample sample;
  sample.effects = {{"missing_bridges", 0.1}};
  return sample;
}

/// What an engine leaves of a test of three beads.
json good_result() {
  return {{"engine", "an engine 1.0"},
          {"beads", 3},
          {"bridges", {{"pairs", {{0, 1}, {1, 2}}}, {"gap_m", {2e-6, 3e-6}}, {"neck_m", {7e-5, 8e-5}}}},
          {"rows", {{0.001, 10.0, 11.0, 0, 1e-4}, {0.002, 20.0, 21.0, 1, 2e-4}}},
          {"frames",
           {{{"strain", 0.002},
             {"displacement_m", {{0, 0, 1e-6}, {0, 0, 2e-6}, {0, 0, 1.0 / 3e6}}},
             {"bonds", {{0, 1}}},
             {"touching", json::array()}}}},
          {"events", {{0.0015, 1, 2}}}};
}

/// What is said of a result with these bytes.
std::string refusal(const std::string& text) {
  ScratchFolder folder;
  write_text(folder / "result.json", text);
  try {
    read_result(folder / "result.json", 3, 1);
  } catch (const ComputationFailed& error) {
    return error.what();
  }
  return "";
}

std::string refusal_with(const json::json_pointer& place, const json& value) {
  json result = good_result();
  result[place] = value;
  return refusal(result.dump());
}

/// PATH with a program `yade` of this text alone before the rest; without one where the text is empty.
class YadeOnPath {
 public:
  YadeOnPath(const ScratchFolder& folder, const std::string& text) : before_(std::getenv("PATH")) {
    const fs::path bin = folder / "bin";
    make_folder(bin);
    if (!text.empty()) {
      write_text(bin / "yade", "#!/bin/sh\n" + text);
      fs::permissions(bin / "yade", fs::perms::owner_all);
    }
    ::setenv("PATH", (text.empty() ? bin.string() : bin.string() + ":" + before_).c_str(), 1);
  }
  ~YadeOnPath() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

/// The result of a run by this `yade`, or what is said of it.
std::string run_with(const std::string& yade, EngineResult* result = nullptr) {
  ScratchFolder folder;
  const YadeOnPath path(folder, yade);
  const Packing packing = three_beads();
  const Sample sample = with_effect();
  try {
    const auto made =
        run_engine({find_engine("yade", "test"), packing, sample, 7, 0.02, {}, {0.002}}, folder / "run");
    if (result) *result = made;
  } catch (const ComputationFailed& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(Engine, IsFoundByItsName) {
  for (const auto& name : engine_names()) EXPECT_EQ(find_engine(name, "here").name, name);
  EXPECT_THROW(find_engine("yad", "here"), BadInput);
  for (const auto& engine : engines()) EXPECT_NE(engine.outside(), !engine.settings.empty()) << engine.name;
}

TEST(Engine, IsToldTheSpecimenToTheLastBit) {
  const Packing packing = three_beads();
  const Sample sample = with_effect();
  const Engine& engine = find_engine("yade_limits", "test");
  const json run = json::parse(run_text({engine, packing, sample, 7, 0.02, {0.01}, {0.015}}));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(run["beads"]["diameter_m"][k].get<double>(), packing.beads[k].diameter);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(run["beads"]["centre_m"][k][axis].get<double>(), packing.beads[k].centre[axis]);
  }
  EXPECT_EQ(run["bridges"]["pairs"], json({{0, 1}, {1, 2}}));
  EXPECT_EQ(run["engine"]["breaking"], "limits");
  EXPECT_EQ(run["effects"], json({{"missing_bridges", 0.1}}));
  EXPECT_EQ(run["test"]["unload_at"], json({0.01}));
  EXPECT_EQ(run["law"]["kn_n_per_m"].get<double>(), micromechanics::bond_stiffness(sample).normal);
}

TEST(Engine, IsToldHowStiffnessFollowsTheBridgesBody) {
  const Packing packing = three_beads();
  Sample sample;
  sample.effects = {{"bridge_gap_spread", 3.0}};
  const json table = json::parse(run_text({engines()[0], packing, sample, 7, 0.02, {}, {}}))["stiffness"];
  const double gap = table["gap_m"][4], neck = table["neck_m"][6];
  const micromechanics::BridgeBody mean = micromechanics::mean_bridge(sample);
  const std::vector<micromechanics::BridgeBody> bodies = {mean,
                                                          {neck, gap, mean.diameter_i, mean.diameter_j}};
  const auto bonds = micromechanics::bridge_stiffnesses(bodies, micromechanics::polymer_of(sample)).bonds;
  EXPECT_NEAR(table["normal"][4][6].get<double>(), bonds[1].normal / bonds[0].normal, 1e-3);
  EXPECT_NEAR(table["twisting"][4][6].get<double>(), bonds[1].twisting / bonds[0].twisting, 1e-3);
}

TEST(Engine, ItsResultIsRead) {
  ScratchFolder folder;
  write_text(folder / "result.json", good_result().dump());
  const EngineResult result = read_result(folder / "result.json", 3, 1);
  EXPECT_EQ(result.engine, "an engine 1.0");
  EXPECT_EQ(result.bonds, (std::vector<std::pair<int, int>>{{0, 1}, {1, 2}}));
  EXPECT_EQ(result.neck[1], 8e-5);
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_EQ(result.rows[1].stress, 20.0);
  EXPECT_EQ(result.rows[1].lateral_strain, 2e-4);
  ASSERT_EQ(result.frames.size(), 1u);
  EXPECT_EQ(result.frames[0].displacement[2].z(), 1.0 / 3e6);
  EXPECT_EQ(result.frames[0].bonds.size(), 1u);
  EXPECT_EQ(result.breaks, std::vector<double>{0.0015});
}

TEST(Engine, ABadResultIsRefusedInOneLine) {
  const auto place = [](const char* text) { return json::json_pointer(text); };
  EXPECT_EQ(refusal(good_result().dump()), "");
  std::vector<std::pair<std::string, std::string>> said = {
      {refusal("{\"rows\": [[NaN]]}"), "a number that is none"},
      {refusal(""), "not JSON"},
      {refusal("{}"), "engine"},
      {refusal_with(place("/rows/0/1"), nullptr), "rows: found null, expected a number"},
      {refusal_with(place("/rows/0"), {1.0, 2.0}), "rows: found 2 numbers, expected 5"},
      {refusal_with(place("/beads"), 4), "beads: found 4, expected 3"},
      {refusal_with(place("/bridges/pairs/0/1"), 3), "found beads 0 and 3, expected two of 3"},
      {refusal_with(place("/bridges/gap_m"), {2e-6}), "bridges.gap_m: found 1 numbers, expected 2"},
      {refusal_with(place("/frames/0/displacement_m"), {{0, 0, 0}}), "found 1 beads, expected 3"},
      {refusal_with(place("/frames"), json::array()), "frames: found 0, expected 1"}};
  for (const auto& [found, expected] : said) {
    EXPECT_NE(found.find(expected), std::string::npos) << found << " has not: " << expected;
    EXPECT_NE(found.find("result.json"), std::string::npos) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
}

TEST(Engine, ItsProcessIsWatched) {
  EngineResult result;
  const std::string result_text = good_result().dump();
  EXPECT_EQ(run_with("for folder; do :; done; test -f $folder/run.json && test -f $4 &&\n"
                     "echo '" +
                         result_text + "' > $folder/result.json\n",
                     &result),
            "");
  EXPECT_EQ(result.rows.size(), 2u);
  EXPECT_NE(run_with("exit 0\n").find("result.json: found no file"), std::string::npos);
  EXPECT_NE(run_with("echo its last line; exit 7\n").find("status 7: its last line"), std::string::npos);
  EXPECT_NE(run_with("").find("yade is not installed"), std::string::npos);
}

TEST(Engine, AMissingOneEndsMakeBeforeAnyCaseIsMade) {
  ScratchFolder folder;
  const fs::path samples = fs::path(pendular::test::source_folder()) / "samples/blind";
  fs::copy(samples / "small_sample.toml", folder / "small_sample.toml");
  std::string text = read_text(samples / "small.toml");
  text.replace(text.find("library = 1"), 11, "other_engine = 1");
  text.replace(text.find("cases = 3"), 9, "cases = 3\nengines = [\"yade\"]");
  write_text(folder / "split.toml", text);
  const auto outcome = pendular::test::shell(folder.path(), "PATH=. $P blind make split.toml -o out");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_NE(outcome.errors.find("engine yade: yade is not installed"), std::string::npos) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder / "out/cases"));
}

/// Stiffness and strength of one bond as Yade has it.
TEST(Engine, YadesBondIsThatOfClosedForms) {
  if (std::system("command -v yade >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "yade is not installed (Debian: apt-get install yade)";
  ScratchFolder folder;
  const std::string source = pendular::test::source_folder();
  const auto outcome =
      pendular::test::shell(folder.path(), "yade -j1 -n -x '" + source + "/tests/blind/yade/two_beads.py' '" +
                                               source + "/blind/yade' > found.txt");
  EXPECT_EQ(outcome.status, 0) << read_text(folder / "found.txt") << outcome.errors;
}

}  // namespace pendular::blind
