#include "packing/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "packing/bridges.h"
#include "packing/exchange.h"
#include "scratch.h"

namespace pendular {
namespace {

/// A face-centred cubic lattice of touching beads of diameter D, cut to a cylinder.
Packing face_centred_cubic(double D, double diameter, double height) {
  Packing packing;
  packing.specimen = {diameter, height, 0.3 * D, -0.2 * D, -0.5 * height};
  const double a = std::sqrt(2.0) * D;  // of the cubic cell
  const int cells = static_cast<int>(std::max(diameter, height) / a) + 2;
  for (int x = -cells; x <= cells; ++x)
    for (int y = -cells; y <= cells; ++y)
      for (int z = -cells; z <= cells; ++z) {
        if ((x + y + z) % 2 != 0) continue;
        const Vec3 at = 0.5 * a * Vec3(x, y, z);
        if (std::hypot(at.x() - 0.3 * D, at.y() + 0.2 * D) > 0.5 * diameter ||
            std::abs(at.z()) > 0.5 * height)
          continue;
        Bead bead;
        bead.id = static_cast<std::int64_t>(packing.beads.size());
        bead.centre = at;
        bead.diameter = D;
        packing.beads.push_back(bead);
      }
  flag_boundary(packing);
  return packing;
}

TEST(Statistics, FaceCentredCubicLattice) {
  constexpr double D = 2e-4;
  Packing packing = face_centred_cubic(D, 24 * D, 22 * D);
  packing.bridges = candidate_bridges(packing.beads, 0.01 * D);
  const auto statistics = packing_statistics(packing, 0.01 * D);
  EXPECT_EQ(statistics.coordination.mean, 12.0);
  EXPECT_EQ(statistics.coordination.standard_error, 0.0);
  EXPECT_EQ(statistics.touching_share, 1.0);
  EXPECT_NEAR(statistics.diameter_sd, 0.0, 1e-15);
  EXPECT_NEAR(statistics.core_volume_fraction, M_PI / std::sqrt(18.0), 0.004);  // the core cuts through cells
  EXPECT_EQ(statistics.coordination_curve.back().coordination, 12.0);           // the next shell is at 0.41 D
  EXPECT_EQ(statistics.coordination_curve[1].coordination, 12.0);
  std::size_t of_interior = 0;
  for (const auto& bridge : packing.bridges)
    of_interior += !packing.beads[static_cast<std::size_t>(bridge.i)].boundary ||
                   !packing.beads[static_cast<std::size_t>(bridge.j)].boundary;
  // Rounding puts a contact on either side of gap 0.
  EXPECT_EQ(statistics.gaps.counts[0] + statistics.gaps.counts[1], of_interior);
}

TEST(Statistics, SphereInCylinderIsExact) {
  Bead bead;
  bead.diameter = 2.0;
  const double sphere = 4.0 / 3.0 * M_PI;
  const auto inside = [&](double x, double z, const Specimen& cylinder) {
    bead.centre = {x, 0, z};
    return volume_fraction_within({bead}, cylinder) * M_PI / 4.0 * std::pow(cylinder.diameter, 2) *
           cylinder.height;
  };
  const Specimen wide{20, 10, 0, 0, 0};
  EXPECT_NEAR(inside(0, 5, wide), sphere, 1e-12);
  EXPECT_NEAR(inside(3, 0, wide), 0.5 * sphere, 1e-12);
  EXPECT_NEAR(inside(0, 9.5, wide), sphere - M_PI * 0.25 * (3.0 - 0.5) / 3.0,
              1e-12);  // a cap of height 0.5 is out
  EXPECT_EQ(inside(0, 11.5, wide), 0.0);
  EXPECT_EQ(inside(11.5, 5, wide), 0.0);
  // A coaxial cylinder of radius c through a unit sphere cuts out 4π/3 (1 − (1 − c²)^(3/2)).
  EXPECT_NEAR(inside(0, 5, {1.2, 10, 0, 0, 0}), sphere * (1.0 - std::pow(0.64, 1.5)), 1e-3);
  // Viviani: a cylinder of half the radius touching the axis cuts out 2π/3 − 8/9.
  EXPECT_NEAR(inside(0.5, 5, {1.0, 10, 0, 0, 0}), 2.0 * M_PI / 3.0 - 8.0 / 9.0, 1e-3);
  // A wall so far away that it is flat halves the sphere.
  EXPECT_NEAR(inside(1e5, 5, {2e5, 10, 0, 0, 0}), 0.5 * sphere, 1e-3);
}

TEST(Statistics, CountsBridgesByStateForInteriorBeads) {
  std::vector<Bead> beads(4);
  beads[3].boundary = true;
  const auto bridge = [](int i, int j, BridgeState state) {
    Bridge b;
    b.i = i;
    b.j = j;
    b.state = state;
    return b;
  };
  const auto result =
      coordination(beads, {bridge(0, 1, BridgeState::bridge), bridge(0, 2, BridgeState::none),
                           bridge(0, 3, BridgeState::candidate), bridge(1, 2, BridgeState::undetermined)});
  EXPECT_EQ(result.beads, 3u);
  EXPECT_DOUBLE_EQ(result.mean, 1.0);                             // 2, 1, 0
  EXPECT_DOUBLE_EQ(result.standard_error, 1.0 / std::sqrt(3.0));  // sd 1
}

TEST(Statistics, CandidatesCarryGapAndItsError) {
  std::vector<Bead> beads(3);
  for (int k = 0; k < 3; ++k) {
    beads[k].centre = {1.1 * k, 0, 0};
    beads[k].diameter = 1.0;
    beads[k].sigma_centre = 0.03;
    beads[k].sigma_diameter = 0.04;
  }
  const auto bridges = candidate_bridges(beads, 0.2);
  ASSERT_EQ(bridges.size(), 2u);
  EXPECT_NEAR(bridges[0].gap, 0.1, 1e-12);
  EXPECT_NEAR(bridges[0].sigma_gap, std::sqrt(2 * 0.03 * 0.03 + 2 * 0.02 * 0.02), 1e-12);
  EXPECT_EQ(bridges[1].state, BridgeState::candidate);
}

TEST(Statistics, SpecimenIsFoundAroundItsBeads) {
  const Packing packing = face_centred_cubic(1.0, 12.0, 9.0);
  const Specimen found = specimen_enclosing(packing.beads);
  for (const auto& bead : packing.beads) {
    EXPECT_LE(std::hypot(bead.centre.x() - found.axis_x, bead.centre.y() - found.axis_y) + 0.5,
              0.5 * found.diameter + 1e-12);
    EXPECT_GE(bead.centre.z() - 0.5, found.bottom - 1e-12);
    EXPECT_LE(bead.centre.z() + 0.5, found.bottom + found.height + 1e-12);
  }
  EXPECT_NEAR(found.axis_x, 0.3, 0.5);
  EXPECT_NEAR(found.diameter, 13.0, 1.0);
}

/// Finney's packing of ball bearings (1970), about 18 ball radii in radius. Published packing fraction:
/// 0.6366 ± 0.0004.
TEST(Statistics, FinneyPacking) {
  const auto file = test::shared_data("finney/FinneyPack.txt");
  if (!file) GTEST_SKIP() << "Finney's coordinates are not in the shared data";
  constexpr double radius = 1e-4;  // m
  Packing packing = read_exchange(*file, ExchangeFormat::xyz, 2.0 * radius);
  for (auto& bead : packing.beads) bead.boundary = bead.centre.norm() > 14.0 * radius;
  EXPECT_NEAR(coordination(packing.beads, candidate_bridges(packing.beads, 0.064 * 2.0 * radius)).mean, 8.2,
              0.1);
  const double fraction =
      volume_fraction_within(packing.beads, {22.0 * radius, 22.0 * radius, 0, 0, -11.0 * radius});
  EXPECT_GT(fraction, 0.637 - 0.001);
  EXPECT_LT(fraction, 0.639 + 0.001);

  std::vector<double> nearest(packing.beads.size(), 1e9);
  for (const auto& pair : candidate_bridges(packing.beads, radius))
    for (const int end : {pair.i, pair.j}) nearest[end] = std::min(nearest[end], pair.gap / radius + 2.0);
  std::nth_element(nearest.begin(), nearest.begin() + nearest.size() / 2, nearest.end());
  EXPECT_NEAR(nearest[nearest.size() / 2], 1.9952, 2e-4);
}

}  // namespace
}  // namespace pendular
