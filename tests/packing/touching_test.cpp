#include "packing/touching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "measured_beads.h"
#include "packing/bridges.h"

namespace pendular {
namespace {

using test::measured_beads;
using test::touching_beads;

constexpr double kSigma = test::kBeadSigma;
constexpr double kTouch = 0.2e-6;  // beads are packed with a margin of some hundredths of a micrometre

/// Root mean square error of the gaps of pairs that truly touch, m.
double error_of_contacts(const std::vector<Bead>& beads) {
  double square = 0.0, count = 0.0;
  for (const auto& pair : candidate_bridges(touching_beads(), kTouch))
    square += std::pow(gap(beads[pair.i], beads[pair.j]), 2), count += 1.0;
  return std::sqrt(square / count);
}

}  // namespace

TEST(Touching, EstimatesHowManyTouch) {
  const double truly = static_cast<double>(candidate_bridges(touching_beads(), kTouch).size());
  ASSERT_GT(truly, 200.0);
  const TouchLikelihood found = touch_likelihood(measured_beads());
  EXPECT_NEAR(found.touching, truly, 0.15 * truly);
  EXPECT_TRUE(found.touches(-kSigma, kSigma));
  EXPECT_TRUE(found.touches(kSigma, kSigma));
  EXPECT_FALSE(found.touches(5.0 * kSigma, kSigma));
}

TEST(Touching, ClosesTheGapsOfBeadsThatTouch) {
  const auto seen = measured_beads();
  const auto closed = closed_contacts(seen);
  EXPECT_GT(error_of_contacts(seen), 1.2 * kSigma);  // √(2 + ½) σ less what touches by chance
  EXPECT_LT(error_of_contacts(closed), 0.3 * error_of_contacts(seen));
  double square = 0.0;
  for (std::size_t k = 0; k < seen.size(); ++k) square += (closed[k].centre - seen[k].centre).squaredNorm();
  EXPECT_LT(std::sqrt(square / (3.0 * static_cast<double>(seen.size()))), kSigma);
}

// Whatever the errors, as long as they are stated.
TEST(Touching, IsNearerToTheTruthThanTheMeasurement) {
  const auto error = [&](const std::vector<Bead>& beads) {
    double square = 0.0;
    for (std::size_t k = 0; k < beads.size(); ++k)
      square += (beads[k].centre - touching_beads()[k].centre).squaredNorm() +
                std::pow(beads[k].diameter - touching_beads()[k].diameter, 2);
    return square;
  };
  const auto truly = candidate_bridges(touching_beads(), kTouch);
  for (const double unreported : {0.0, 1e-6, 2e-6}) {
    auto seen = measured_beads(unreported);
    for (auto& bead : seen) bead.sigma_centre = std::hypot(kSigma, unreported);
    const auto closed = closed_contacts(seen);
    EXPECT_LT(error(closed), 0.6 * error(seen)) << unreported;
    std::size_t found = 0;
    for (const auto& pair : truly) found += gap(closed[pair.i], closed[pair.j]) < 0.02 * seen[0].sigma_centre;
    EXPECT_GT(found, 0.95 * static_cast<double>(truly.size())) << unreported;
    EXPECT_LT(touching_pairs(closed), 1.15 * static_cast<double>(truly.size())) << unreported;
  }
}

// Also where errors are larger than stated, and beads are moved farther than by these.
TEST(Touching, LeavesNoOverlap) {
  for (const double unreported : {0.0, 2e-6, 4e-6})
    for (const auto& pair : candidate_bridges(closed_contacts(measured_beads(unreported)), 0.0))
      EXPECT_GT(pair.gap, -0.01 * pair.sigma_gap) << unreported;
}

TEST(Touching, FlatEndsBecomeFlatAgain) {
  const auto ends = [](const std::vector<Bead>& beads, double way) {
    std::vector<double> heights;
    for (const auto& bead : beads) heights.push_back(way * bead.centre.z() - 0.5 * bead.diameter);
    std::sort(heights.begin(), heights.end());
    return heights;
  };
  const auto seen = measured_beads(), closed = closed_contacts(seen);
  for (const double way : {1.0, -1.0}) {
    const auto truly = ends(touching_beads(), way);
    const auto on_it = static_cast<std::size_t>(
        std::count_if(truly.begin(), truly.end(), [&](double h) { return h < truly.front() + kTouch; }));
    ASSERT_GT(on_it, 15u);
    EXPECT_GT(ends(seen, way)[on_it - 1] - ends(seen, way).front(), 2.0 * kSigma);
    EXPECT_LT(ends(closed, way)[on_it - 3] - ends(closed, way).front(), 0.1 * kSigma);
    EXPECT_NEAR(ends(closed, way).front(), truly.front(), 0.4 * kSigma);
  }
}

TEST(Touching, LeavesAloneWhatIsApartOrExact) {
  EXPECT_EQ(closed_contacts(touching_beads())[5].centre, touching_beads()[5].centre);
  std::vector<Bead> lattice(8);
  for (int k = 0; k < 8; ++k) {
    lattice[k].centre = 205e-6 * Vec3(k & 1, (k >> 1) & 1, k >> 2);
    lattice[k].diameter = 200e-6;
    lattice[k].sigma_centre = lattice[k].sigma_diameter = kSigma;
  }
  const auto closed = closed_contacts(lattice);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(closed[k].centre, lattice[k].centre);
}

}  // namespace pendular
