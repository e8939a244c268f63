#include "packing/exchange.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "packing/statistics.h"
#include "scratch.h"
#include "small_packing.h"

namespace pendular {
namespace {

using test::ScratchFolder;
using test::small_packing;

struct Case {
  const char* name;
  ExchangeFormat format;
  bool keeps_ids;
  bool keeps_bonds;
  double tolerance;  ///< m
};

class Exchange : public ::testing::TestWithParam<Case> {};

TEST_P(Exchange, RoundTrip) {
  const auto& [name, format, keeps_ids, keeps_bonds, tolerance] = GetParam();
  const ScratchFolder scratch;
  const Packing packing = small_packing();
  write_exchange(scratch / "f", format, packing, 2500.0);
  const Packing read = read_exchange(scratch / "f", format);
  ASSERT_EQ(read.beads.size(), packing.beads.size());
  for (std::size_t k = 0; k < read.beads.size(); ++k) {
    EXPECT_LE((read.beads[k].centre - packing.beads[k].centre).norm(), tolerance);
    EXPECT_NEAR(read.beads[k].diameter, packing.beads[k].diameter, tolerance);
    EXPECT_EQ(read.beads[k].id, keeps_ids ? packing.beads[k].id : static_cast<std::int64_t>(k) + 1);
  }
  std::vector<std::pair<int, int>> bonds, expected;
  for (const auto& bridge : read.bridges) bonds.emplace_back(bridge.i, bridge.j);
  for (const auto& bridge : packing.bridges)
    if (bridge.state == BridgeState::bridge || bridge.state == BridgeState::candidate)
      expected.emplace_back(bridge.i, bridge.j);
  EXPECT_EQ(bonds, keeps_bonds ? expected : decltype(expected){});
  EXPECT_GT(read.specimen.diameter, 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, Exchange,
                         ::testing::Values(Case{"csv", ExchangeFormat::csv, true, false, 1e-12},
                                           Case{"yade", ExchangeFormat::yade, false, false, 1e-18},
                                           Case{"lammps", ExchangeFormat::lammps, true, true, 0.0},
                                           Case{"lammps_bpm", ExchangeFormat::lammps_bpm, true, true, 0.0},
                                           Case{"liggghts", ExchangeFormat::liggghts, true, false, 0.0}),
                         [](const auto& entry) { return entry.param.name; });

TEST(ExchangeFormats, OtherLammpsStyles) {
  const ScratchFolder scratch;
  const std::string head = "title 3 atoms\n\n2 atoms\n 1 bonds # that many\n1 atom types\n-1 1 xlo xhi\n\n";
  const std::string tail = "\nVelocities\n\n1 0 0 0\n2 0 0 0\n\nBond Coeffs\n\n1 5\n\nBonds\n\n1 1 8 3\n";
  const std::string lines[] = {
      "Atoms # sphere\n\n8 1 5e-4 2500 1e-3 2e-3 3e-3 0 0 0\n3 1 4e-4 2500 1e-3 2.6e-3 3e-3\n",
      "Atoms # bpm/sphere\n\n8 1 1 5e-4 2500 1e-3 2e-3 3e-3\n3 1 1 4e-4 2500 1e-3 2.6e-3 3e-3\n",
      "Atoms # hybrid sphere bond\n\n8 1 1e-3 2e-3 3e-3 5e-4 2500 1\n3 1 1e-3 2.6e-3 3e-3 4e-4 2500 1\n"};
  for (const auto& atoms : lines) {
    write_text(scratch / "a.data", head + atoms + tail);
    const Packing read = read_exchange(scratch / "a.data", ExchangeFormat::lammps);
    ASSERT_EQ(read.beads.size(), 2u) << atoms;
    EXPECT_EQ(read.beads[1].centre, Vec3(1e-3, 2.6e-3, 3e-3)) << atoms;
    EXPECT_EQ(read.beads[1].diameter, 4e-4) << atoms;
    ASSERT_EQ(read.bridges.size(), 1u) << atoms;
    EXPECT_NEAR(read.bridges[0].gap, 1.5e-4, 1e-15) << atoms;
  }
}

struct BadFile {
  const char* name;
  ExchangeFormat format;
  std::string text;
};

class BadExchange : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadExchange, IsBadInput) {
  const ScratchFolder scratch;
  write_text(scratch / "f", GetParam().text);
  EXPECT_THROW(read_exchange(scratch / "f", GetParam().format, 1e-4), BadInput);
}

using enum ExchangeFormat;
const std::string kAtoms = "t\n2 atoms\n1 bonds\n\nAtoms\n\n1 1 1 9 0 0 0\n2 1 1 9 2 0 0\n";
INSTANTIATE_TEST_SUITE_P(
    All, BadExchange,
    ::testing::Values(BadFile{"yade_nothing", yade, "#format x_y_z_r\n"},
                      BadFile{"yade_short", yade, "1 2 3\n"}, BadFile{"yade_word", yade, "1 2 3 r\n"},
                      BadFile{"yade_radius", yade, "1 2 3 -1\n"}, BadFile{"yade_inf", yade, "inf 2 3 1\n"},
                      BadFile{"xyz_id", xyz, "a 1 2 3\n"},
                      BadFile{"atoms_cut", lammps, "t\n3 atoms\n\nAtoms\n\n1 1 1 9 0 0 0\n"},
                      BadFile{"bonds_cut", lammps, kAtoms},
                      BadFile{"bond_unknown", lammps, kAtoms + "\nBonds\n\n1 1 1 5\n"},
                      BadFile{"bond_itself", lammps, kAtoms + "\nBonds\n\n1 1 2 2\n"},
                      BadFile{"bond_short", lammps, kAtoms + "\nBonds\n\n1 1 2\n"},
                      BadFile{"style", lammps, "t\n1 atoms\n\nAtoms # full\n\n1 1 1 0 0 0 0\n"},
                      BadFile{"atom_short", liggghts, "t\n1 atoms\n\nAtoms\n\n1 1 1 0 0\n"}),
    [](const auto& entry) { return entry.param.name; });

TEST(ExchangeFormats, NamesAndExtensions) {
  EXPECT_EQ(exchange_format("lammps"), lammps);
  EXPECT_THROW(exchange_format("LAMMPS"), BadUsage);
  EXPECT_EQ(exchange_format_of("a/b.vtp"), vtp);
  EXPECT_EQ(exchange_format_of("b.txt"), yade);
  EXPECT_THROW(exchange_format_of("b.dat"), BadUsage);
  Packing packing = small_packing(2);
  packing.beads[0].id = 0;
  const ScratchFolder scratch;
  EXPECT_THROW(write_exchange(scratch / "f", lammps, packing, 2500.0), BadInput);
  EXPECT_THROW(write_exchange(scratch / "f", xyz, packing, 2500.0), BadUsage);
  write_text(scratch / "f.xyz", "1 0 0 0\n2 2 0 0\n");
  EXPECT_THROW(read_exchange(scratch / "f.xyz", xyz), BadUsage);  // the unit is not known
  EXPECT_NEAR(read_exchange(scratch / "f.xyz", xyz, 2e-4).beads[1].centre.x(), 2e-4, 1e-18);
}

const std::string kDdic =
    "Label\tZpos\tYpos\tXpos\tFzz\tZdisp\tFyy\tYdisp\tFxx\tXdisp\treturnStatus\terror\n"
    "0.000\t0.0\t0.0\t0.0\t1\t0.0\t1\t0.0\t1\t0.0\t0\t0.1\n"
    "1.000\t10.0\t20.0\t30.5\t1\t-1.0\t1\t0.5\t1\t0.25\t2\t0.1\n"
    "2.000\t60.0\t20.0\t30.0\t1\t0.0\t1\t0.0\t1\t0.0\t1\t0.1\n"
    "3.000\tnan\tnan\tnan\t1\tnan\t1\tnan\t1\tnan\t-7\tnan\n"
    "4.000\t10.0\t70.0\t30.0\t1\t2.0\t1\t0.0\t1\t0.0\t2\t0.1\n";

TEST(ExchangeSpam, BeadsBeforeAndAfterOfADdicTable) {
  const ScratchFolder scratch;
  write_text(scratch / "ddic.tsv", kDdic);
  const auto before = read_spam(scratch / "ddic.tsv", {5e-6, false}, 2e-4);
  ASSERT_EQ(before.size(), 3u);
  EXPECT_EQ(before[1].id, 2);
  EXPECT_LT((before[0].centre - Vec3(152.5e-6, 100e-6, 50e-6)).norm(), 1e-15);
  EXPECT_EQ(before[0].diameter, 2e-4);
  const auto after = read_spam(scratch / "ddic.tsv", {5e-6, true}, 2e-4);
  ASSERT_EQ(after.size(), 2u);
  EXPECT_EQ(after[1].id, 4);
  EXPECT_LT((after[0].centre - Vec3(153.75e-6, 102.5e-6, 45e-6)).norm(), 1e-15);
}

TEST(ExchangeSpam, ATableOfBeadsMayHoldRadii) {
  const ScratchFolder scratch;
  write_text(scratch / "beads.tsv", "Label\tZpos\tYpos\tXpos\tradius\n3\t10\t20\t30\t18.5\n");
  const Packing packing =
      read_exchange(scratch / "beads.tsv", exchange_format_of("beads.tsv"), {}, {10e-6, false});
  ASSERT_EQ(packing.beads.size(), 1u);
  EXPECT_NEAR(packing.beads[0].diameter, 370e-6, 1e-15);
}

TEST(ExchangeSpam, WhatIsWrongIsSaid) {
  const ScratchFolder scratch;
  const auto expect = [&](const std::string& text, const SpamTable& table, const std::string& part) {
    write_text(scratch / "a.tsv", text);
    try {
      read_spam(scratch / "a.tsv", table, 2e-4);
      ADD_FAILURE() << part;
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  expect("", {5e-6, false}, "found nothing");
  expect("a\tb\n1\t2\n", {5e-6, false}, "found no column Label or NodeNumber");
  expect("Label\tZpos\tYpos\tXpos\n1\t2\t3\t4\n", {5e-6, true}, "found no column Xdisp");
  expect("Label\tZpos\tYpos\tXpos\n1\t2\t3\n", {5e-6, false}, "a.tsv:2: found 3 words");
  expect("Label\tZpos\tYpos\tXpos\n1\t2\tx\t4\n", {5e-6, false}, "a.tsv:2: word 3: found \"x\"");
  expect("Label\tZpos\tYpos\tXpos\n1.5\t2\t3\t4\n", {5e-6, false}, "expected a whole number");
  expect("Label\tZpos\tYpos\tXpos\n0\t2\t3\t4\n", {5e-6, false}, "found no beads");
  write_text(scratch / "a.tsv", kDdic);
  EXPECT_THROW(read_spam(scratch / "a.tsv", {}, 2e-4), BadUsage);
  EXPECT_THROW(read_spam(scratch / "a.tsv", {5e-6, false}, {}), BadUsage);
}

}  // namespace
}  // namespace pendular
