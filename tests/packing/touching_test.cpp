#include "packing/touching.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/sample.h"
#include "packing/bridges.h"
#include "packing/generate.h"

namespace pendular {
namespace {

constexpr double kSigma = 0.3e-6;
constexpr double kTouch = 0.2e-6;  // beads are packed with a margin of some hundredths of a micrometre

/// A packing of some 250 beads, many of which touch.
const std::vector<Bead>& true_beads() {
  static const std::vector<Bead> beads = [] {
    const Sample sample = parse_sample(
        "[beads]\ndiameter_um = 200\ndiameter_sd_um = 2\ndiameters = \"measured\"\n"
        "[specimen]\ndiameter_um = 1300\nheight_um = 1300\nvolume_fraction = 0.58\n",
        "test");
    return generate_packing(sample, 7).beads;
  }();
  return beads;
}

std::vector<Bead> measured(std::vector<Bead> beads) {
  for (std::size_t k = 0; k < beads.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      beads[k].centre[axis] += kSigma * random_normal(11, 4 * k + static_cast<std::size_t>(axis));
    beads[k].diameter += kSigma * random_normal(11, 4 * k + 3);
    beads[k].sigma_centre = beads[k].sigma_diameter = kSigma;
  }
  return beads;
}

/// Root mean square error of the gaps of pairs that truly touch, m.
double error_of_contacts(const std::vector<Bead>& beads) {
  double square = 0.0, count = 0.0;
  for (const auto& pair : candidate_bridges(true_beads(), kTouch))
    square += std::pow(gap(beads[pair.i], beads[pair.j]), 2), count += 1.0;
  return std::sqrt(square / count);
}

}  // namespace

TEST(Touching, EstimatesHowManyTouch) {
  const double truly = static_cast<double>(candidate_bridges(true_beads(), kTouch).size());
  ASSERT_GT(truly, 200.0);
  const TouchLikelihood found = touch_likelihood(measured(true_beads()));
  EXPECT_NEAR(found.touching, truly, 0.15 * truly);
  EXPECT_TRUE(found.touches(-kSigma, kSigma));
  EXPECT_TRUE(found.touches(kSigma, kSigma));
  EXPECT_FALSE(found.touches(5.0 * kSigma, kSigma));
}

TEST(Touching, ClosesTheGapsOfBeadsThatTouch) {
  const auto seen = measured(true_beads());
  const auto closed = closed_contacts(seen);
  EXPECT_GT(error_of_contacts(seen), 1.2 * kSigma);  // √(2 + ½) σ less what touches by chance
  EXPECT_LT(error_of_contacts(closed), 0.3 * error_of_contacts(seen));
  double square = 0.0;
  for (std::size_t k = 0; k < seen.size(); ++k) square += (closed[k].centre - seen[k].centre).squaredNorm();
  EXPECT_LT(std::sqrt(square / (3.0 * static_cast<double>(seen.size()))), kSigma);
}

TEST(Touching, IsNearerToTheTruthThanTheMeasurement) {
  const auto seen = measured(true_beads());
  const auto closed = closed_contacts(seen);
  const auto error = [&](const std::vector<Bead>& beads) {
    double square = 0.0;
    for (std::size_t k = 0; k < beads.size(); ++k)
      square += (beads[k].centre - true_beads()[k].centre).squaredNorm() +
                std::pow(beads[k].diameter - true_beads()[k].diameter, 2);
    return square;
  };
  EXPECT_LT(error(closed), 0.8 * error(seen));
}

TEST(Touching, LeavesAloneWhatIsApartOrExact) {
  EXPECT_EQ(closed_contacts(true_beads())[5].centre, true_beads()[5].centre);
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
