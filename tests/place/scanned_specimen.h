#pragma once

#include <functional>

#include "base/random.h"
#include "dem_core/linear/joints.h"
#include "diagnosis/repair/place.h"
#include "specimens.h"

namespace pendular::test {

constexpr double kScanStrain = 0.01, kScanSigma = 0.14e-6;

inline dem_core::Simulation scanned_specimen() {
  return dem_core::build_simulation(disordered(5, 5), sample_a());
}

/// The specimen's displacements as a linear network with the contacts that are closed at rest; `softer`: the
/// factor on the springs about a place.
inline std::vector<Vec3> network_motion(const dem_core::Simulation& specimen,
                                        const std::function<double(const Vec3&)>& softer) {
  const auto joints = dem_core::joints_of(specimen, kScanStrain * specimen.initial_height);
  dem_core::NodeVector x =
      dem_core::NodeVector::Zero(6 * static_cast<Eigen::Index>(specimen.beads.size() + 2));
  for (std::size_t k = 0; k < specimen.beads.size(); ++k)
    x[6 * static_cast<Eigen::Index>(k) + 2] = kScanStrain * (specimen.top.z - specimen.beads.position[k].z());
  x[6 * static_cast<Eigen::Index>(specimen.beads.size()) + 2] = kScanStrain * specimen.initial_height;
  const dem_core::SpringNetwork network = dem_core::network_of(
      specimen, joints, dem_core::closures_at(dem_core::nodes_of(specimen), joints, x), true);
  auto springs = network.springs();
  for (auto& spring : springs) {
    const double factor = softer(specimen.beads.position[static_cast<std::size_t>(spring.i)]);
    spring.normal *= factor, spring.tangential *= factor, spring.push *= factor;
  }
  const dem_core::SpringNetwork changed = network.with(springs);
  solve(changed, changed.pushes(), 1e-8, x);
  std::vector<Vec3> moved;
  for (std::size_t k = 0; k < specimen.beads.size(); ++k)
    moved.push_back(x.segment<3>(6 * static_cast<Eigen::Index>(k)));
  return moved;
}

inline std::vector<Vec3> with_noise(std::vector<Vec3> field, double sigma, std::uint64_t seed) {
  for (std::size_t k = 0; k < field.size(); ++k)
    for (int axis = 0; axis < 3; ++axis)
      field[k][axis] += sigma * random_normal(seed, 3 * k + static_cast<unsigned>(axis));
  return field;
}

inline std::vector<std::int64_t> ids_of(const dem_core::Simulation& specimen) {
  std::vector<std::int64_t> ids;
  for (std::size_t k = 0; k < specimen.beads.size(); ++k) ids.push_back(static_cast<std::int64_t>(k) + 1);
  return ids;
}

/// Ten members that scatter by 0.05 µm, and a measurement with noise of its own.
inline diagnosis::ScannedMotion scan_of(const dem_core::Simulation& specimen,
                                        const std::function<double(const Vec3&)>& softer,
                                        std::uint64_t seed) {
  diagnosis::ScannedMotion scan{kScanStrain, ids_of(specimen), specimen.beads.position, {}, kScanSigma, {}};
  const auto as_believed = network_motion(specimen, [](const Vec3&) { return 1.0; });
  for (std::uint64_t member = 0; member < 10; ++member)
    scan.simulated.push_back(with_noise(as_believed, 0.05e-6, 100 + member));
  scan.measured = with_noise(network_motion(specimen, softer), std::hypot(kScanSigma, 0.05e-6), seed);
  return scan;
}

}  // namespace pendular::test
