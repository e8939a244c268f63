#include "micromechanics/stiffness.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "micromechanics/stiffness_table.h"

namespace pendular::micromechanics {
namespace {

constexpr std::size_t kMostKept = 256;  // bridges

/// Parts of a run, and the runs of a bank in one process, ask for the stiffness of the same few bridges.
BridgeStiffness kept_stiffness(const BridgeBody& body, const Polymer& polymer) {
  static std::mutex guard;
  static std::map<std::array<double, 6>, BridgeStiffness> kept;
  check_bridge(body, polymer);  // what is not finite has no place in the order of keys
  const std::lock_guard lock(guard);
  const std::array key = {body.neck_diameter,     body.gap,
                          body.diameter_i,        body.diameter_j,
                          polymer.youngs_modulus, polymer.poisson_ratio};
  if (const auto known = kept.find(key); known != kept.end()) return known->second;
  if (kept.size() == kMostKept) kept.clear();
  return kept[key] = bridge_stiffness(body, polymer);
}

}  // namespace

Polymer polymer_of(const Sample& sample) {
  return {sample.bridges.youngs_modulus, sample.bridges.poisson_ratio};
}

BridgeBody mean_bridge(const Sample& sample) {
  return {sample.bridges.diameter, sample.bridges.gap, sample.beads.diameter, sample.beads.diameter};
}

BondStiffness bond_stiffness(const Sample& sample) {
  const auto &normal = sample.bridges.normal_stiffness, &tangential = sample.bridges.tangential_stiffness;
  if (normal.has_value() != tangential.has_value())
    bad_input(
        "sample: bridges.{}: found alone, expected normal_stiffness_n_per_m and "
        "tangential_stiffness_n_per_m, or "
        "neither",
        normal ? "normal_stiffness_n_per_m" : "tangential_stiffness_n_per_m");
  BondStiffness bond = kept_stiffness(mean_bridge(sample), polymer_of(sample));
  if (normal) {
    bond.normal = *normal;
    bond.tangential = *tangential;
  }
  return bond;
}

BridgeStiffnesses bridge_stiffnesses(std::span<const BridgeBody> bodies, const Polymer& polymer) {
  const StiffnessTable table(bodies, polymer);
  BridgeStiffnesses result;
  result.interpolation_error = table.measured_error();
  result.bonds.resize(bodies.size());
  for_blocks(bodies.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) result.bonds[k] = table.at(bodies[k]);
  });
  result.raised_gaps = static_cast<std::size_t>(std::count_if(
      bodies.begin(), bodies.end(), [](const BridgeBody& body) { return gap_is_raised(body); }));
  return result;
}

std::vector<BondStiffness> bond_stiffnesses(const Sample& sample, std::span<const BridgeBody> bodies) {
  if (sample.bridges.stiffness == StiffnessOf::one)
    return std::vector<BondStiffness>(bodies.size(), bond_stiffness(sample));
  if (sample.bridges.normal_stiffness || sample.bridges.tangential_stiffness)
    bad_input(
        "sample: bridges.stiffness: found \"per_bridge\" and a stated stiffness, which is the same for all "
        "bonds; "
        "expected one of them");
  BridgeStiffnesses each = bridge_stiffnesses(bodies, polymer_of(sample));
  if (each.interpolation_error > 1e-3)
    warn(
        fmt::format("stiffness per bridge: interpolated to {:.2g} %, because bridges differ beyond the usual",
                    100.0 * each.interpolation_error));
  return std::move(each.bonds);
}

}  // namespace pendular::micromechanics
