#include "diagnosis/experiment/specimens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/model_version.h"
#include "base/path_kind.h"
#include "base/random.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "packing/bridges.h"
#include "packing/measurement.h"
#include "packing/statistics.h"
#include "packing/tables.h"
#include "packing/vtp.h"

namespace pendular::diagnosis {
namespace {

constexpr double kLargestMismatch = 1.25;  // of diameters and of the specimen's size

/// Beads of another specimen, or in another unit, are not simulated as if they were this one's.
void check_beads_of(const Condition& condition, const std::vector<Bead>& beads) {
  const Sample& sample = condition.sample;
  const auto check = [&](const char* what, double found, double expected) {
    if (found > kLargestMismatch * expected || found < expected / kLargestMismatch)
      bad_input(
          "{}: found {} of {:.4g} um, expected about {:.4g} um as the sample says (beads of another "
          "specimen?)",
          condition.beads.string(), what, 1e6 * found, 1e6 * expected);
  };
  const Specimen held = specimen_enclosing(beads);
  check("a mean diameter", mean_diameter(beads), sample.beads.diameter);
  check("a specimen diameter", held.diameter, sample.specimen.diameter);
  check("a specimen height", held.height, sample.specimen.height);
}

/// Another measurement of the same beads: it has the errors of both.
void move_beads(std::vector<Bead>& beads, std::uint64_t seed) {
  for (std::size_t k = 0; k < beads.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      beads[k].centre[axis] +=
          beads[k].sigma_centre * random_normal(seed, 4 * k + static_cast<std::size_t>(axis));
    beads[k].diameter += beads[k].sigma_diameter * random_normal(seed, 4 * k + 3);
    beads[k].sigma_centre *= M_SQRT2, beads[k].sigma_diameter *= M_SQRT2;
  }
}

/// Pairs as they were measured: what has no bridge has none, undetermined ones stay candidates. `moved`:
/// necks by their stated errors, as another measurement might have them.
void use_network(const fs::path& path, double cutoff, bool moved, std::uint64_t seed, Packing& packing) {
  std::vector<Bridge> network = read_bridges(path, packing.beads);
  const auto without = pairs_without(packing.beads, network, cutoff * mean_diameter(packing.beads));
  network.insert(network.end(), without.begin(), without.end());
  for (Bridge bridge : network) {
    if (bridge.state == BridgeState::undetermined) bridge.state = BridgeState::candidate;
    if (moved && bridge.diameter > 0.0)
      bridge.diameter += bridge.sigma_diameter * random_normal(seed, effects::of_pair(bridge.i, bridge.j));
    bridge.gap = gap(packing.beads[static_cast<std::size_t>(bridge.i)],
                     packing.beads[static_cast<std::size_t>(bridge.j)]);
    const auto at = std::lower_bound(
        packing.bridges.begin(), packing.bridges.end(), bridge,
        [](const Bridge& a, const Bridge& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
    if (at != packing.bridges.end() && at->i == bridge.i && at->j == bridge.j)
      *at = bridge;
    else if (bridge.state == BridgeState::bridge)
      packing.bridges.insert(at, bridge);
  }
}

/// The measured packing that the effects of `changed` make into the likeliest specimen where they hold.
Packing measured_packing(const Condition& condition, int member, const Sample& changed) {
  std::vector<Bead> beads = read_beads(condition.beads);
  check_beads_of(condition, beads);
  if (member > 1 && member < kFirstFresh) move_beads(beads, static_cast<std::uint64_t>(member));
  Packing packing = packing_of(effects::actual_beads(std::move(beads), changed), condition.sample);
  if (!condition.network.empty())
    use_network(condition.network, condition.sample.bridges.cutoff, member > 1 && member < kFirstFresh,
                static_cast<std::uint64_t>(member), packing);
  // The bytes name the runs of a store, whatever commit wrote them.
  packing.provenance = {fmt::format("model {}", kModelVersion),
                        fmt::format("pendular diagnose: member {}", member),
                        static_cast<std::uint64_t>(member),
                        {}};
  return effects::reading(packing, changed, static_cast<std::uint64_t>(member));
}

/// What the effects on the measurement of beads do to the packing, in words; empty: nothing.
std::string measured_otherwise(const Sample& changed) {
  std::string words;
  for (const auto& [id, theta] : changed.effects)
    if (effects::find_effect(id, "diagnosis").beads) words += fmt::format(" {} {}", id, theta);
  return words;
}

}  // namespace

sweep::PackingSource MemberPackings::of(const Condition& condition, int member, const Sample& changed) {
  if (condition.beads.empty()) return sweep::generated_packing(static_cast<std::uint64_t>(member));
  const auto& s = condition.sample;
  const std::string what = fmt::format("{} {} {} {} {}{}", member, s.specimen.diameter, s.specimen.height,
                                       s.bridges.cutoff, s.beads.diameter, measured_otherwise(changed));
  const std::string key =
      fmt::format("{}\n{}\n{}", condition.beads.string(), condition.network.string(), what);
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  const std::string name = sha256(
      fmt::format("closed {} {}{}", sha256_of(condition.beads), what,
                  condition.network.empty() ? "" : fmt::format(" network {}", sha256_of(condition.network))));
  const fs::path path = folder_ / (name.substr(0, 16) + ".vtp");
  make_inner_folder(folder_);
  if (!is_there(path)) write_packing(path, measured_packing(condition, member, changed));
  return known_[key] = sweep::packing_file(path);
}

double beads_in(const Condition& condition) {
  if (!condition.beads.empty()) return static_cast<double>(read_beads(condition.beads).size());
  const auto& s = condition.sample;
  const double cylinder = 0.25 * M_PI * s.specimen.diameter * s.specimen.diameter * s.specimen.height;
  return s.specimen.volume_fraction * cylinder / (M_PI / 6.0 * std::pow(s.beads.diameter, 3));
}

}  // namespace pendular::diagnosis
