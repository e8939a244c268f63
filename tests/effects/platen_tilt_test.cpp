#include "tests.h"

namespace pendular::effects::test {
namespace {

using Slope = Eigen::Vector2d;

dem_core::Simulation tilted(double theta, std::uint64_t seed) {
  return actual_simulation(actual_specimen(chains(), with("platen_tilt", theta), seed));
}

/// Of the top platen: the plane through what its face lies back at the beads, and how far it is off that.
Slope slope_of(const dem_core::Simulation& s, double& off) {
  Eigen::MatrixXd places(static_cast<Eigen::Index>(s.beads.size()), 3);
  for (std::size_t k = 0; k < s.beads.size(); ++k)
    places.row(static_cast<Eigen::Index>(k)) << s.beads.position[k].x(), s.beads.position[k].y(), 1.0;
  const Eigen::VectorXd relief =
      Eigen::VectorXd::Map(s.top.relief.data(), static_cast<Eigen::Index>(s.top.relief.size()));
  const Eigen::Vector3d plane = places.colPivHouseholderQr().solve(relief);
  off = (places * plane - relief).cwiseAbs().maxCoeff();
  return plane.head<2>();
}

TEST(PlatenTilt, IsAPlaneThatTouchesTheHighestBead) {
  const dem_core::Simulation s = tilted(1.0, 1);
  double off = 1.0, nearest = 1.0;
  EXPECT_NEAR(slope_of(s, off).norm(), std::tan(M_PI / 180.0), 1e-12);
  EXPECT_LT(off, 1e-15);
  for (std::size_t k = 0; k < s.beads.size(); ++k)
    nearest = std::min(nearest, s.top.gap(k, s.beads.position[k].z(), s.beads.radius[k]));
  EXPECT_NEAR(nearest, 0.0, 1e-15);
  EXPECT_EQ(s.bottom.z, dem_core::build_simulation(chains(), with("platen_tilt", 1.0)).bottom.z);
}

TEST(PlatenTilt, HasAnyDirectionAndTheSameAtAnyMagnitude) {
  double off = 0.0;
  Slope sum = Slope::Zero();
  constexpr int kSeeds = 100;
  for (int seed = 1; seed <= kSeeds; ++seed)
    sum += slope_of(tilted(1.0, static_cast<std::uint64_t>(seed)), off).normalized();
  EXPECT_LT(sum.norm(), 3.0 * std::sqrt(kSeeds));  // that of a random walk
  const Slope one = slope_of(tilted(0.5, 7), off), other = slope_of(tilted(2.0, 7), off);
  EXPECT_NEAR(one.normalized().dot(other.normalized()), 1.0, 1e-12);
}

TEST(PlatenTilt, ChainsTouchOneAfterTheOther) {
  // Each as the face has come down to it: forces add up.
  Sample sample = with("platen_tilt", 0.05, 1e-3);
  sample.compression.relax_to = 1e-5;
  const auto done = run(chains(), sample);
  const std::vector<double> back = tilted(0.05, 1).top.relief;
  const double k = chain_stiffness(5760.0), first = *std::min_element(back.begin(), back.end());
  const double height = (5.0 * (1.0 + kGap) + 1.0) * kBeadDiameter;
  const double section = 0.25 * M_PI * std::pow(sample.specimen.diameter, 2);
  for (const auto& row : done.rows) {
    const double travel = row.strain * done.result["specimen"]["height_um"].get<double>() * 1e-6;
    double force = 0.0;
    for (std::size_t chain = 0; chain < 9; ++chain)
      force += k * std::max(0.0, travel - (back[chain] - first));
    EXPECT_NEAR(row.stress * section, force, 1e-3 * 9.0 * k * height * 2e-3) << row.strain;
  }
  EXPECT_LT(done.rows.back().stress, 0.95 * run(chains(), without(sample)).rows.back().stress);
}

}  // namespace
}  // namespace pendular::effects::test
