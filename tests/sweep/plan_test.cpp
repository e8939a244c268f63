#include "sweep/plan.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "packing/vtp.h"
#include "scratch.h"
#include "sweep_files.h"

namespace pendular::sweep {
namespace {

using test::ScratchFolder;
using test::write_sweep;

Plan plan_in(const fs::path& folder) {
  return plan_of(read_sweep(folder / "sweep.toml"));
}

TEST(Plan, HasEveryCombinationInTheFilesOrder) {
  ScratchFolder folder;
  write_sweep(folder.path(),
              "seed = 7\nrealisations = 2\n"
              "[grid]\n\"bridges.youngs_modulus_pa\" = [1e5, 1e6]\nbeads.diameters = [\"drawn\"]\n"
              "[[list]]\n\"bridges.gap_um\" = [1, 2, 3]\n\"compression.max_strain\" = [0.05, 0.06, 0.07]\n");
  const Plan plan = plan_in(folder.path());
  EXPECT_EQ(plan.keys, (std::vector<std::string>{"bridges.youngs_modulus_pa", "beads.diameters",
                                                 "bridges.gap_um", "compression.max_strain"}));
  ASSERT_EQ(plan.runs.size(), 12u);
  std::size_t k = 0;
  for (const double modulus : {1e5, 1e6})
    for (const double gap : {1.0, 2.0, 3.0})
      for (const int realisation : {1, 2}) {
        const auto& run = plan.runs[k];
        EXPECT_EQ(run.point, k / 2 + 1);
        EXPECT_EQ(run.realisation, realisation);
        EXPECT_EQ(run.seed, 6u + static_cast<unsigned>(realisation));
        const Sample& sample = plan.requests[k].sample;
        EXPECT_DOUBLE_EQ(sample.bridges.youngs_modulus, modulus);
        EXPECT_DOUBLE_EQ(sample.bridges.gap, 1e-6 * gap);
        EXPECT_DOUBLE_EQ(sample.compression.max_strain, 0.04 + 0.01 * gap);
        EXPECT_EQ(plan.requests[k].packing.seed, 7u) << "all share one packing";
        EXPECT_EQ(plan.requests[k].seed, run.seed);
        ++k;
      }
}

TEST(Plan, EachRealisationMayHaveAPackingOfItsOwn) {
  ScratchFolder folder;
  write_sweep(folder.path(), "seed = 3\nrealisations = 2\npackings = \"each\"\nkeep = \"all\"\n");
  const Plan plan = plan_in(folder.path());
  ASSERT_EQ(plan.requests.size(), 2u);
  EXPECT_EQ(plan.requests[0].packing.seed, 3u);
  EXPECT_EQ(plan.requests[1].packing.seed, 4u);
  EXPECT_TRUE(plan.requests[1].keep_all);
  const Plan seeded = plan_of(read_sweep(folder / "sweep.toml", 10));
  EXPECT_EQ(seeded.requests[1].seed, 11u);
}

TEST(Plan, PolymerContentScalesTheNeckThatTheOtherKeysSet) {
  ScratchFolder folder;
  write_sweep(folder.path(), "[grid]\nW = [0.01, 0.04]\n\"bridges.diameter_um\" = [60]\n",
              test::tiny_sample() + "[bridges.x]\n");
  EXPECT_THROW(plan_in(folder.path()), BadInput) << "the sample has a section that it must not have";
  write_text(folder / "s.toml", test::sample_file("[bridges]\npolymer_content = 0.01\n"));
  const Plan plan = plan_in(folder.path());
  ASSERT_EQ(plan.requests.size(), 2u);
  EXPECT_NEAR(plan.requests[0].sample.bridges.diameter, 60e-6, 1e-18);
  EXPECT_NEAR(plan.requests[1].sample.bridges.diameter, 120e-6, 1e-18) << "W goes as the square of d";
}

TEST(Plan, AVariedKeyCountsAsIfTheSampleFileHadIt) {
  ScratchFolder folder;
  std::string sample = test::tiny_sample();
  const std::string stated = "platen_friction = 0.5\n";
  ASSERT_NE(sample.find(stated), std::string::npos);
  sample.erase(sample.find(stated), stated.size());  // then a platen is like another bead
  write_sweep(folder.path(), "[grid]\n\"contact.friction\" = [0.1, 0.2]\n", sample);
  const Plan plan = plan_in(folder.path());
  EXPECT_DOUBLE_EQ(plan.requests[1].sample.contact.platen_friction, 0.2) << "platens are like beads";
}

TEST(Plan, RealisationsOfAPackingThatStatesErrorsWouldBeTheSame) {
  ScratchFolder folder;
  Packing packing;
  packing.beads.resize(2);
  packing.beads[1].id = 1, packing.beads[1].centre = Vec3(0, 0, 205e-6);
  for (auto& bead : packing.beads) bead.diameter = 200e-6;
  packing.specimen = {1e-3, 1e-3};
  write_packing(folder / "p.vtp", packing);
  write_sweep(folder.path(), "packing = \"p.vtp\"\nrealisations = 2\n");
  EXPECT_EQ(plan_in(folder.path()).requests.size(), 2u);
  for (auto& bead : packing.beads) bead.sigma_centre = 1e-7;
  write_packing(folder / "p.vtp", packing);
  EXPECT_THROW(plan_in(folder.path()), BadInput);
  write_sweep(folder.path(),
              "packing = \"p.vtp\"\nrealisations = 2\n[grid]\nbeads.diameters = [\"drawn\"]\n");
  EXPECT_EQ(plan_in(folder.path()).requests.size(), 2u);
}

struct BadSweep {
  const char* name;
  const char* text;
  const char* expected;
};

class SweepBadInput : public testing::TestWithParam<BadSweep> {};

TEST_P(SweepBadInput, NamesFileLineKeyAndExpectation) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::tiny_sample());
  write_text(folder / "measured.toml",
             test::tiny_sample("max_strain = 0.01\n", "[beads]\ndiameters = \"measured\"\n"));
  write_text(folder / "noise.vtp", "no packing");
  write_text(folder / "sweep.toml", GetParam().text);
  try {
    plan_in(folder.path());
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

#define HEAD "[sweep]\nsample = \"s.toml\"\n"
INSTANTIATE_TEST_SUITE_P(
    Table, SweepBadInput,
    testing::Values(
        BadSweep{"Syntax", "[sweep\n", "sweep.toml:1"},
        BadSweep{"NoSample", "[sweep]\nname = \"x\"\n", "sweep.sample is missing"},
        BadSweep{"AbsentSample", "[sweep]\nsample = \"absent.toml\"\n",
                 "sweep.toml:2: sweep.sample: found \"absent"},
        BadSweep{"NoPacking", HEAD "packing = \"noise.vtp\"\n", "noise.vtp"},
        BadSweep{
            "HeadKey", HEAD "realisation = 3\n",
            "sweep.toml:3: sweep.realisation: unknown key, the nearest known one is \"sweep.realisations\""},
        BadSweep{"Section", HEAD "[grids]\nW = [1]\n", "sweep.toml:3: grids: unknown section"},
        BadSweep{"UnknownKey", HEAD "[grid]\n\"bridges.youngs_modulus_mpa\" = [1]\n",
                 "sweep.toml:4: bridges.youngs_modulus_mpa: unknown key, the nearest known one is "
                 "\"bridges.youngs_modulus_pa\""},
        BadSweep{"EmptyGrid", HEAD "[grid]\n", "empty grid"},
        BadSweep{"EmptyValues", HEAD "[grid]\nW = []\n", "sweep.toml:4: W: found an empty array"},
        BadSweep{"NoArray", HEAD "[grid]\nW = 0.01\n", "W: found a number, expected an array of values"},
        BadSweep{"OutOfRange", HEAD "[grid]\n\"bridges.poisson_ratio\" = [0.3, 0.5]\n",
                 "sweep.toml:4: bridges.poisson_ratio: found 0.5, expected a number from 0 to 0.4999"},
        BadSweep{"WrongKind", HEAD "[grid]\n\"bridges.poisson_ratio\" = [\"low\"]\n", "found a string"},
        BadSweep{"WrongWord", HEAD "[grid]\n\"bridges.stiffness\" = [\"all\"]\n", "\"one\", \"per_bridge\""},
        BadSweep{"Content", HEAD "[grid]\nW = [2.3]\n", "W: found 2.3, expected fractions"},
        BadSweep{"NeckAsLargeAsABead", HEAD "[grid]\nW = [0.01, 0.3]\n",
                 "W = 0.3: bridges.diameter_um = 266.9"},
        BadSweep{"UnequalList", HEAD "[[list]]\nW = [0.01, 0.02]\n\"bridges.gap_um\" = [1]\n",
                 "found 1 values, expected 2 as W has"},
        BadSweep{"Twice", HEAD "[grid]\nW = [0.01]\n[[list]]\nW = [0.02]\n",
                 "sweep.toml:6: W: is varied twice"},
        BadSweep{"TooMany", HEAD "realisations = 60000\n[grid]\nW = [0.01, 0.02]\n", "found 120000 runs"},
        BadSweep{"Realisations", HEAD "realisations = 0\n", "expected an integer from 1"},
        BadSweep{"Keep", HEAD "keep = \"nothing\"\n", "\"curve\" or \"all\""},
        BadSweep{"TwoPackings", HEAD "packings = \"each\"\npacking_seed = 3\n", "expected one of them"},
        BadSweep{"SameRealisations", "[sweep]\nsample = \"measured.toml\"\nrealisations = 2\n",
                 "would be the same"},
        BadSweep{"Together", HEAD "[grid]\n\"compression.control\" = [\"speed\", \"stress\"]\n",
                 "compression.control = stress: compression.control"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular::sweep
