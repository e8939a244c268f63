#include "packing/pack.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/progress.h"
#include "packing/bridges.h"
#include "packing/check.h"
#include "packing/generate.h"

namespace pendular {
namespace {

constexpr double kLargestClosing = 1.5;  // of the stated errors; where these hold it is about 0.8

/// Beads in another unit than µm differ from the sample's by powers of ten.
void check_unit(const std::vector<Bead>& beads, const Sample& sample, const PackNames& names) {
  const double mean = mean_diameter(beads), expected = sample.beads.diameter;
  if (mean > 3.0 * expected || mean < expected / 3.0)
    bad_input(
        "{}: column diameter_um: found a mean of {:.4g}, expected about {:.4g} (beads.diameter_um of {}; "
        "wrong unit?)",
        names.beads, 1e6 * mean, 1e6 * expected, names.sample);
}

/// Beads tell twice how large they are, by their width and by how far apart those lie that touch. A wrong
/// voxel size scales both.
void check_scale(const std::vector<Bead>& beads, const Structure& structure, const Sample& sample) {
  constexpr double alike = 0.025;
  const double said = sample.beads.diameter, mean = mean_diameter(beads), peak = structure.first_peak;
  const auto differ = [](double a, double b) { return std::fabs(a / b - 1.0) > alike; };
  if (peak == 0.0) return;
  if (differ(peak, mean))
    warn(
        fmt::format("the beads are {:.1f} um wide on average, but g(r) has its first peak at {:.1f} um: "
                    "diameters may be biased",
                    1e6 * mean, 1e6 * peak));
  else if (differ(peak, said) && differ(mean, said))
    warn(
        fmt::format("the beads are {:.1f} um wide and g(r) has its first peak at {:.1f} um, the sample says "
                    "{:.1f} um: the voxel size may be {:.3f} times what it should be",
                    1e6 * mean, 1e6 * peak, 1e6 * said, peak / said));
}

void check_extent(const Packing& packing) {
  const Specimen held = specimen_enclosing(packing.beads);
  const Specimen& said = packing.specimen;
  const double tolerance = 0.1 * mean_diameter(packing.beads);
  if (held.diameter > said.diameter + tolerance || held.height > said.height + tolerance)
    warn(fmt::format(
        "the beads fill a cylinder {:.1f} um wide and {:.1f} um high, the sample says {:.1f} and {:.1f}",
        1e6 * held.diameter, 1e6 * held.height, 1e6 * said.diameter, 1e6 * said.height));
}

/// Their gaps change by as much as the beads were moved from where they were measured.
std::vector<Bridge> measured_bridges(std::vector<Bridge> bridges, const std::vector<Bead>& measured,
                                     const std::vector<Bead>& beads, const std::string& name) {
  std::erase_if(bridges, [](const Bridge& bridge) { return bridge.state != BridgeState::bridge; });
  if (bridges.empty()) bad_input("{}: found no row in state bridge, expected measured bridges", name);
  for (auto& b : bridges) b.gap += gap(beads[b.i], beads[b.j]) - gap(measured[b.i], measured[b.j]);
  return bridges;
}

/// What closing their contacts did to the beads of a table; nothing where none are closed.
std::optional<Closing> closing_of(const Sample& sample, const std::vector<Bead>& measured,
                                  const Packing& packing) {
  if (!states_errors(measured) || diameters_used(sample, measured) == Diameters::drawn) return std::nullopt;
  const Closing found = closing(measured, packing.beads);
  if (found.rms_over_errors > kLargestClosing)
    warn(
        fmt::format("closing contacts moved beads by {:.1f} times their stated errors: these may be too "
                    "small, or diameters biased",
                    found.rms_over_errors));
  return found;
}

Packed described(Packing packing, const Sample& sample) {
  Packed packed{std::move(packing), {}, {}, {}, {}};
  packed.statistics = packing_statistics(packed.packing, sample.bridges.cutoff * sample.beads.diameter);
  packed.structure = structure_of(packed.packing);
  packed.diameters = diameters_used(sample, packed.packing.beads);
  return packed;
}

nlohmann::ordered_json to_json(const Closing& closing) {
  return {{"pairs", closing.contacts},
          {"centre_rms_um", 1e6 * closing.centre_rms},
          {"diameter_rms_um", 1e6 * closing.diameter_rms},
          {"rms_over_stated_errors", closing.rms_over_errors}};
}

}  // namespace

Packed pack_beads(const std::vector<Bead>& measured, const std::optional<std::vector<Bridge>>& bridges,
                  const Sample& sample, const PackNames& names) {
  check_unit(measured, sample, names);
  if (diameters_used(sample, measured) == Diameters::measured) check_overlaps(measured, names.beads);
  Packing packing = packing_of(measured, sample);
  check_extent(packing);
  if (bridges) packing.bridges = measured_bridges(*bridges, measured, packing.beads, names.bridges);
  Packed packed = described(std::move(packing), sample);
  check_scale(packed.packing.beads, packed.structure, sample);
  packed.closed = closing_of(sample, measured, packed.packing);
  return packed;
}

Packed pack_generated(const Sample& sample, std::uint64_t seed) {
  Packing packing = generate_packing(sample, seed);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  return described(std::move(packing), sample);
}

nlohmann::ordered_json to_json(const Packed& packed) {
  nlohmann::ordered_json json = to_json(packed.statistics);
  json["structure"] = to_json(packed.structure);
  json["diameters"] = to_string(packed.diameters);
  if (packed.closed) json["closed_contacts"] = to_json(*packed.closed);
  return json;
}

}  // namespace pendular
