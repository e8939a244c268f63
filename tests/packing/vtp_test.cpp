#include "packing/vtp.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "packing/polydata.h"
#include "scratch.h"
#include "small_packing.h"

namespace pendular {
namespace {

using test::ScratchFolder;
using test::small_packing;

void expect_length(double read, double written) {
  EXPECT_NEAR(read, written, 1e-15 * std::abs(written));
}

TEST(PackingFile, RoundTrip) {
  const ScratchFolder scratch;
  const Packing packing = small_packing();
  write_packing(scratch / "p.vtp", packing);
  const Packing read = read_packing(scratch / "p.vtp");
  ASSERT_EQ(read.beads.size(), packing.beads.size());
  for (std::size_t k = 0; k < read.beads.size(); ++k) {
    const Bead &a = read.beads[k], &b = packing.beads[k];
    EXPECT_EQ(std::tie(a.id, a.quality, a.boundary), std::tie(b.id, b.quality, b.boundary));
    for (int axis = 0; axis < 3; ++axis) expect_length(a.centre[axis], b.centre[axis]);
    expect_length(a.diameter, b.diameter);
    expect_length(a.sigma_centre, b.sigma_centre);
    expect_length(a.sigma_diameter, b.sigma_diameter);
  }
  ASSERT_EQ(read.bridges.size(), packing.bridges.size());
  for (std::size_t k = 0; k < read.bridges.size(); ++k) {
    const Bridge &a = read.bridges[k], &b = packing.bridges[k];
    EXPECT_EQ(std::tie(a.i, a.j, a.probability, a.state), std::tie(b.i, b.j, b.probability, b.state));
    expect_length(a.gap, b.gap);
    expect_length(a.sigma_gap, b.sigma_gap);
    expect_length(a.diameter, b.diameter);
    expect_length(a.sigma_diameter, b.sigma_diameter);
  }
  expect_length(read.specimen.diameter, packing.specimen.diameter);
  expect_length(read.specimen.height, packing.specimen.height);
  expect_length(read.specimen.axis_x, packing.specimen.axis_x);
  expect_length(read.specimen.axis_y, packing.specimen.axis_y);
  expect_length(read.specimen.bottom, packing.specimen.bottom);
  EXPECT_EQ(to_json(read.provenance), to_json(packing.provenance));
}

TEST(PackingFile, NoBridgesAtAll) {
  const ScratchFolder scratch;
  Packing packing = small_packing(2);
  packing.bridges.clear();
  write_packing(scratch / "p.vtp", packing);
  EXPECT_TRUE(read_packing(scratch / "p.vtp").bridges.empty());
}

struct Damage {
  const char* name;
  void (*change)(PolyTable&);
};

class WrongPackingFile : public ::testing::TestWithParam<Damage> {};

TEST_P(WrongPackingFile, IsBadInput) {
  const ScratchFolder scratch;
  write_packing(scratch / "p.vtp", small_packing(3));
  PolyTable table = read_polydata(scratch / "p.vtp");
  GetParam().change(table);
  write_polydata(scratch / "p.vtp", table);
  EXPECT_THROW(read_packing(scratch / "p.vtp"), BadInput);
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongPackingFile,
    ::testing::Values(
        Damage{"no_version", [](PolyTable& p) { p.number_fields.erase("format_version"); }},
        Damage{"later_version", [](PolyTable& p) { p.number_fields["format_version"] = 99; }},
        Damage{"no_specimen", [](PolyTable& p) { p.number_fields.erase("specimen_height_um"); }},
        Damage{"flat_specimen", [](PolyTable& p) { p.number_fields["specimen_height_um"] = 0; }},
        Damage{"no_diameters", [](PolyTable& p) { p.point_data.erase(p.point_data.begin() + 1); }},
        Damage{"no_gaps", [](PolyTable& p) { p.line_data.erase(p.line_data.begin()); }},
        Damage{"one_place", [](PolyTable& p) { p.points[1] = p.points[0]; }},
        Damage{"pair_twice",
               [](PolyTable& p) {
                 p.lines[1] = {p.lines[0][1], p.lines[0][0]};
               }},
        Damage{"to_itself",
               [](PolyTable& p) {
                 p.lines[0] = {2, 2};
               }},
        Damage{"state",
               [](PolyTable& p) { std::get<std::vector<std::int64_t>>(p.line_data[5].second)[0] = 4; }},
        Damage{"provenance", [](PolyTable& p) { p.text_fields["provenance"] = "{"; }}),
    [](const auto& entry) { return entry.param.name; });

}  // namespace
}  // namespace pendular
