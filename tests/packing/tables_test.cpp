#include "packing/tables.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "packing/check.h"
#include "scratch.h"
#include "small_packing.h"

namespace pendular {
namespace {

using test::ScratchFolder;
using test::small_packing;

TEST(Tables, BeadsRoundTrip) {
  const ScratchFolder scratch;
  const auto beads = small_packing().beads;
  write_beads(scratch / "beads.csv", beads, small_packing().provenance);
  const auto read = read_beads(scratch / "beads.csv");
  ASSERT_EQ(read.size(), beads.size());
  for (std::size_t k = 0; k < beads.size(); ++k) {
    EXPECT_EQ(read[k].id, beads[k].id);
    EXPECT_LT((read[k].centre - beads[k].centre).norm(), 1e-12);
    EXPECT_NEAR(read[k].diameter, beads[k].diameter, 1e-12);
    EXPECT_NEAR(read[k].sigma_centre, beads[k].sigma_centre, 1e-12);
    EXPECT_NEAR(read[k].sigma_diameter, beads[k].sigma_diameter, 1e-12);
    EXPECT_NEAR(read[k].quality, beads[k].quality, 1e-6);
    EXPECT_EQ(read[k].boundary, beads[k].boundary);
  }
  write_beads(scratch / "again.csv", read, small_packing().provenance);
  EXPECT_EQ(read_text(scratch / "again.csv"), read_text(scratch / "beads.csv"));
}

TEST(Tables, BridgesRoundTrip) {
  const ScratchFolder scratch;
  const Packing packing = small_packing();
  write_bridges(scratch / "bridges.csv", packing.beads, packing.bridges, packing.provenance);
  const auto read = read_bridges(scratch / "bridges.csv", packing.beads);
  ASSERT_EQ(read.size(), packing.bridges.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    const Bridge &a = read[k], &b = packing.bridges[k];
    EXPECT_EQ(std::tie(a.i, a.j, a.state), std::tie(b.i, b.j, b.state));
    EXPECT_NEAR(a.gap, b.gap, 1e-12);
    EXPECT_NEAR(a.sigma_gap, b.sigma_gap, 1e-12);
    EXPECT_NEAR(a.probability, b.probability, 1e-6);
    EXPECT_NEAR(a.diameter, b.diameter, 1e-12);
    EXPECT_NEAR(a.sigma_diameter, b.sigma_diameter, 1e-12);
  }
}

TEST(Tables, NumbersThatMeanNothingAreEmptyCells) {
  const ScratchFolder scratch;
  Packing packing = small_packing();
  packing.beads[0].sigma_centre = std::numeric_limits<double>::quiet_NaN();
  packing.bridges[0].sigma_gap = std::numeric_limits<double>::infinity();
  write_beads(scratch / "beads.csv", packing.beads, packing.provenance);
  write_bridges(scratch / "bridges.csv", packing.beads, packing.bridges, packing.provenance);
  for (const char* name : {"beads.csv", "bridges.csv"}) {
    const std::string text = read_text(scratch / name);
    EXPECT_NE(text.find(",,"), std::string::npos) << text;
    for (const char* word : {"nan", "inf"}) EXPECT_EQ(text.find(word), std::string::npos) << text;
  }
}

TEST(Tables, MissingOptionalColumnsAndForeignOnes) {
  const ScratchFolder scratch;
  write_text(scratch / "beads.csv",
             "colour,bead_id,x_um,y_um,z_um,diameter_um\nred,4,1,2,3,200\n\nblue,9,250,2,3,200\n");
  const auto beads = read_beads(scratch / "beads.csv");
  ASSERT_EQ(beads.size(), 2u);
  EXPECT_EQ(beads[1].id, 9);
  EXPECT_EQ(beads[1].quality, 1.0);
  EXPECT_EQ(beads[1].sigma_centre, 0.0);
  write_text(scratch / "bridges.csv", "bead_j,bead_i\n4,9\n");
  const auto bridges = read_bridges(scratch / "bridges.csv", beads);
  ASSERT_EQ(bridges.size(), 1u);
  EXPECT_EQ(bridges[0].i, 0);
  EXPECT_NEAR(bridges[0].gap, 49e-6, 1e-15);
  EXPECT_EQ(bridges[0].state, BridgeState::bridge);
}

struct BadTable {
  const char* name;
  std::string text;
  std::string said;  ///< part of the message
};

class BadBeads : public ::testing::TestWithParam<BadTable> {};

TEST_P(BadBeads, AreBadInput) {
  const ScratchFolder scratch;
  write_text(scratch / "b.csv", GetParam().text);
  try {
    read_beads(scratch / "b.csv");
    FAIL() << "was read";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().said), std::string::npos) << error.what();
  }
}

const std::string kHead = "bead_id,x_um,y_um,z_um,diameter_um\n";
INSTANTIATE_TEST_SUITE_P(
    All, BadBeads,
    ::testing::Values(BadTable{"empty", "", "b.csv"}, BadTable{"header_only", kHead, "no bead"},
                      BadTable{"column", "bead_id,x_um,y_um,z_um\n1,2,3,4\n", "diameter_um"},
                      BadTable{"twice", kHead + "1,0,0,0,9\n# a\n1,20,0,0,9\n", "b.csv:4"},
                      BadTable{"zero", kHead + "1,0,0,0,9\n2,20,0,0,0\n", "b.csv:3"},
                      BadTable{"negative", kHead + "1,0,0,0,-9\n", "b.csv:2"},
                      BadTable{"nan", kHead + "1,0,nan,0,9\n", "b.csv:2"},
                      BadTable{"word", kHead + "1,0,left,0,9\n", "y_um"},
                      BadTable{"fraction", kHead + "1.5,0,0,0,9\n", "bead_id"},
                      BadTable{"short", kHead + "1,0,0\n", "b.csv"},
                      BadTable{"overlap", kHead + "8,0,0,0,9\n5,4,0,0,9\n", "beads 8 and 5"},
                      BadTable{"sigma", "bead_id,x_um,y_um,z_um,diameter_um,sigma_centre_um\n1,0,0,0,9,-1\n",
                               "sigma_centre_um"}),
    [](const auto& entry) { return entry.param.name; });

class BadBridges : public ::testing::TestWithParam<BadTable> {};

TEST_P(BadBridges, AreBadInput) {
  const ScratchFolder scratch;
  std::vector<Bead> beads(3);
  for (int k = 0; k < 3; ++k) beads[static_cast<std::size_t>(k)].id = k + 1;
  write_text(scratch / "b.csv", "bead_i,bead_j,gap_um,state\n" + GetParam().text);
  try {
    read_bridges(scratch / "b.csv", beads);
    FAIL() << "was read";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().said), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(All, BadBridges,
                         ::testing::Values(BadTable{"unknown", "1,2,0,none\n1,7,0,none\n", "b.csv:3"},
                                           BadTable{"itself", "2,2,0,none\n", "b.csv:2"},
                                           BadTable{"twice", "1,2,0,none\n2,3,0,none\n2,1,0,none\n",
                                                    "b.csv:4"},
                                           BadTable{"state", "1,2,0,perhaps\n", "b.csv:2"},
                                           BadTable{"gap", "1,2,wide,none\n", "gap_um"}),
                         [](const auto& entry) { return entry.param.name; });

TEST(CheckBeads, NamesWhatIsWrong) {
  const auto beads = small_packing(2).beads;
  EXPECT_NO_THROW(check_beads(beads, "f"));
  EXPECT_THROW(check_beads({}, "f"), BadInput);
  auto bad = beads;
  bad[3].id = bad[5].id;
  EXPECT_THROW(check_beads(bad, "f"), BadInput);
  bad = beads;
  bad[3].centre.y() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(check_beads(bad, "f"), BadInput);
  bad = beads;
  bad[3].diameter = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check_beads(bad, "f"), BadInput);
  bad = beads;
  bad[3].centre = bad[5].centre + Vec3(0, 0, 0.45 * bad[5].diameter);
  EXPECT_THROW(check_beads(bad, "f"), BadInput);
}

TEST(BridgeStates, WordsRoundTrip) {
  for (const auto state :
       {BridgeState::candidate, BridgeState::bridge, BridgeState::none, BridgeState::undetermined})
    EXPECT_EQ(bridge_state(to_string(state)), state);
  EXPECT_THROW(bridge_state("Bridge"), BadInput);
}

}  // namespace
}  // namespace pendular
