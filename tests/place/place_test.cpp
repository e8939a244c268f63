#include "diagnosis/repair/place.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dem_core/linear/stiffness_sensitivity.h"
#include "scanned_specimen.h"

namespace pendular::diagnosis {
namespace {

using namespace pendular::test;

/// Springs in series between the platens, as many as there are gaps between beads and platens.
dem_core::SpringNetwork chain(const std::vector<double>& stiffness) {
  const int beads = static_cast<int>(stiffness.size()) - 1;
  std::vector<dem_core::NetworkSpring> springs;
  for (int k = 0; k + 1 < beads; ++k)
    springs.push_back(
        {k + 1, k, Vec3::UnitZ(), 1.0, 1.0, stiffness[static_cast<std::size_t>(k) + 1], 0.1, 0, 0, 0});
  springs.push_back({0, beads, Vec3::UnitZ(), 1.0, 0.0, stiffness.front(), 0.1, 0, 0, 0});
  springs.push_back({beads - 1, beads + 1, -Vec3::UnitZ(), 1.0, 0.0, stiffness.back(), 0.1, 0, 0, 0});
  return {std::vector<double>(static_cast<std::size_t>(beads) + 2, 1.0), springs};
}

/// Of springs in series each has the part 1/k of the travel over Σ 1/k.
TEST(Place, ChainWithAWeakSpringIsFoundWithTheRightMagnitude) {
  constexpr std::size_t kSprings = 12, kWeak = 5;
  constexpr double kWeaker = 0.9, kTravel = 1.0, kNoise = 1e-4;
  const dem_core::SpringNetwork network = chain(std::vector<double>(kSprings, 1.0));
  dem_core::NodeVector x = dem_core::NodeVector::Zero(6 * network.nodes());
  x[6 * network.bottom() + 2] = kTravel;
  solve(network, network.pushes(), 1e-12, x);
  const double whole = kSprings - 1.0 + 1.0 / kWeaker;
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(3 * network.free_nodes());
  for (int bead = 0; bead < network.free_nodes(); ++bead) {
    const double passed = bead + 1.0 + (bead >= static_cast<int>(kWeak) ? 1.0 / kWeaker - 1.0 : 0.0);
    difference[3 * bead + 2] = kTravel * (1.0 - passed / whole) - x[6 * bead + 2];
    EXPECT_NEAR(x[6 * bead + 2], kTravel * (1.0 - (bead + 1.0) / kSprings), 1e-9);
  }
  // The springs of chain() in the order from platen to platen: the first bead's, those between, the last's.
  Eigen::MatrixXd sensitivity(difference.size(), static_cast<Eigen::Index>(kSprings));
  const auto place_of_spring = [](std::size_t k) {
    return k == 0 ? kSprings - 2 : k + 1 == kSprings ? k : k - 1;
  };
  for (std::size_t k = 0; k < kSprings; ++k) {
    std::vector<double> one(kSprings, 0.0);
    one[place_of_spring(k)] = 1.0;
    const dem_core::NodeVector change = dem_core::stiffness_sensitivity(network, x, one, 1e-12);
    for (int bead = 0; bead < network.free_nodes(); ++bead)
      sensitivity.block<3, 1>(3 * bead, static_cast<Eigen::Index>(k)) = change.segment<3>(6 * bead);
  }
  const RegionFit fit =
      fit_regions(regions_of(sensitivity, Eigen::MatrixXd::Identity(kSprings, kSprings)),
                  Eigen::VectorXd::Constant(difference.size(), kNoise * kNoise), difference);
  // Only ratios of springs in series show: the others share what the prior leaves of their common factor.
  double others = 0.0;
  for (std::size_t k = 0; k < kSprings; ++k)
    if (k != kWeak) others += fit.change[static_cast<Eigen::Index>(k)] / (kSprings - 1.0);
  EXPECT_NEAR(fit.change[kWeak] - others, std::log(kWeaker), 0.1 * std::fabs(std::log(kWeaker)));
  for (std::size_t k = 0; k < kSprings; ++k)
    EXPECT_NEAR(fit.change[static_cast<Eigen::Index>(k)] - others, k == kWeak ? std::log(kWeaker) : 0.0,
                0.02);
  EXPECT_GT(std::fabs(fit.change[kWeak]), 5.0 * std::sqrt(fit.covariance(kWeak, kWeak)));
}

TEST(Place, NothingPlantedShowsNothing) {
  const dem_core::Simulation specimen = scanned_specimen();
  int alarms = 0;
  for (std::uint64_t seed : {1, 2, 3}) {
    const Place place = place_of(scan_of(
                                     specimen, [](const Vec3&) { return 1.0; }, seed),
                                 specimen, ids_of(specimen));
    alarms += place.count() > 0;
    EXPECT_NE(place.words.find("Nowhere"), std::string::npos) << place.words;
  }
  EXPECT_EQ(alarms, 0);
}

TEST(Place, WeakLayerIsFoundAndSofter) {
  const dem_core::Simulation specimen = scanned_specimen();
  const double middle = 0.5 * (specimen.bottom.z + specimen.top.z), half = specimen.beads.mean_diameter();
  const auto of_layer = [&](const Vec3& p) { return std::fabs(p.z() - middle) < half; };
  const Place place = place_of(scan_of(
                                   specimen, [&](const Vec3& p) { return of_layer(p) ? 0.3 : 1.0; }, 9),
                               specimen, ids_of(specimen));
  double larger = 0.0, pairs = 0.0, inside = 0.0, outside = 0.0, count = 0.0;
  for (std::size_t a = 0; a < place.ids.size(); ++a) {
    if (!of_layer(place.rest[a])) {
      outside += place.stiffness.change[a] / static_cast<double>(place.ids.size());
      continue;
    }
    inside += place.stiffness.change[a], count += 1.0;
    for (std::size_t b = 0; b < place.ids.size(); ++b)
      if (!of_layer(place.rest[b])) pairs += 1.0, larger += place.misfit.value[a] > place.misfit.value[b];
  }
  EXPECT_GT(place.count(), 10u);
  EXPECT_GT(larger / pairs, 0.9);
  EXPECT_LT(inside / count, std::log(0.7));
  EXPECT_LT(inside / count, outside - 0.1);
}

}  // namespace
}  // namespace pendular::diagnosis
