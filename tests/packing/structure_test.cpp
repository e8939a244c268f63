#include "packing/structure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "packing/generate.h"
#include "packing/statistics.h"

namespace pendular {
namespace {

constexpr double kDiameter = 200e-6;

/// Beads on a cubic lattice that touch along the axes, cut by a cylinder in thought.
Packing lattice(int n) {
  Packing packing;
  for (int k = 0; k < n * n * n; ++k) {
    Bead bead;
    bead.id = k + 1;
    bead.centre = kDiameter * (Vec3(k % n, k / n % n, k / n / n) + Vec3::Constant(0.5));
    bead.diameter = kDiameter;
    packing.beads.push_back(bead);
  }
  packing.specimen = {n * kDiameter, n * kDiameter, 0.5 * n * kDiameter, 0.5 * n * kDiameter, 0.0};
  return packing;
}

/// Points without order, as beads of no size.
Packing gas() {
  Packing packing;
  packing.specimen = {2e-3, 2e-3, 0.0, 0.0, 0.0};
  for (std::uint64_t k = 0; packing.beads.size() < 5000; ++k) {
    const Vec3 p(2e-3 * random_uniform(1, k) - 1e-3, 2e-3 * random_uniform(2, k) - 1e-3,
                 2e-3 * random_uniform(3, k));
    if (p.head<2>().norm() > 1e-3) continue;
    Bead bead;
    bead.centre = p, bead.diameter = 100e-6;
    packing.beads.push_back(bead);
  }
  return packing;
}

TEST(Structure, PointsWithoutOrderHaveAFlatRadialDistribution) {
  const Structure structure = structure_of(gas());
  ASSERT_EQ(structure.g.size(), 150u);
  double mean = 0.0;
  for (std::size_t k = 50; k < 150; ++k) mean += structure.g[k] / 100.0;
  EXPECT_NEAR(mean, 1.0, 0.03);
}

TEST(Structure, ALatticeHasItsShells) {
  const Structure structure = structure_of(lattice(12));
  double first = 0.0, second = 0.0, between = 0.0;
  for (std::size_t k = 0; k < structure.g.size(); ++k) {
    const double r = structure.r_over_d[k];
    if (std::fabs(r - 1.0) < 0.03) first += structure.g[k];
    if (std::fabs(r - M_SQRT2) < 0.03) second += structure.g[k];
    if (r > 1.05 && r < 1.35) between += structure.g[k];
  }
  EXPECT_GT(first, 10.0);
  EXPECT_GT(second, 10.0);
  EXPECT_EQ(between, 0.0);
  // Six neighbours over 4πr² Δr per cubed diameter.
  EXPECT_NEAR(first * 4.0 * M_PI * 0.02, 6.0, 0.5);
}

TEST(Structure, TheFirstPeakIsWhereBeadsTouchWhateverTheirDiameters) {
  Packing packing = lattice(12);
  EXPECT_NEAR(structure_of(packing).first_peak / kDiameter, 1.0, 0.011);
  for (Bead& bead : packing.beads) bead.diameter *= 1.07;
  EXPECT_NEAR(structure_of(packing).first_peak / kDiameter, 1.0, 0.011);
  EXPECT_EQ(structure_of(gas()).first_peak, 0.0);
}

TEST(Structure, OrientationAndNecksOfKnownBridges) {
  Packing packing = lattice(3);
  const auto bridge = [&](int i, int j, double diameter) {
    packing.bridges.push_back({i, j, 0.0, 0.0, 1.0, diameter, 0.0, BridgeState::bridge});
  };
  bridge(0, 1, 60e-6);    // along x
  bridge(0, 9, 100e-6);   // along z
  bridge(13, 14, 60e-6);  // along x, alone
  bridge(13, 22, 0.0);    // along z, its neck not known
  packing.bridges.push_back({1, 2, 0.0, 0.0, 0.0, 60e-6, 0.0, BridgeState::none});
  const Structure structure = structure_of(packing);
  EXPECT_EQ(structure.bridges, 4.0);
  EXPECT_DOUBLE_EQ(structure.cos2, 0.5);
  EXPECT_EQ(structure.orientation.front(), 2u);
  EXPECT_EQ(structure.orientation.back(), 2u);
  EXPECT_NEAR(structure.neck_diameter, 220e-6 / 3.0, 1e-12);
  EXPECT_EQ(structure.meeting, 0u);  // asin 0.3 + asin 0.5 is less than a right angle
  // To leading order a neck between touching balls holds π a⁴/(2 R).
  Packing one = lattice(3);
  one.bridges = {{0, 1, 0.0, 0.0, 1.0, 20e-6, 0.0, BridgeState::bridge}};
  EXPECT_NEAR(structure_of(one).polymer_volume / (M_PI * std::pow(10e-6, 4) / (2.0 * 100e-6)), 1.0, 0.01);
  packing.bridges[0].diameter = packing.bridges[1].diameter = 150e-6;
  EXPECT_EQ(structure_of(packing).meeting, 2u);  // twice asin 0.75 is more
}

TEST(Structure, SlabsAddUpToTheWhole) {
  Sample sample;
  sample.specimen.diameter = sample.specimen.height = 1.5e-3, sample.specimen.volume_fraction = 0.55;
  const Packing packing = generate_packing(sample, 1);
  const Structure structure = structure_of(packing);
  double mean = 0.0;
  for (const double fraction : structure.slab_fraction) mean += fraction / 10.0;
  EXPECT_NEAR(mean, volume_fraction_within(packing.beads, packing.specimen), 1e-3);
}

}  // namespace
}  // namespace pendular
