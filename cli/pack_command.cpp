#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/progress.h"
#include "base/sample.h"
#include "cli/command.h"
#include "packing/bridges.h"
#include "packing/check.h"
#include "packing/generate.h"
#include "packing/measurement.h"
#include "packing/statistics.h"
#include "packing/structure.h"
#include "packing/tables.h"
#include "packing/vtp.h"

namespace pendular::cli {
namespace {

constexpr double kLargestClosing = 1.5;  // of the stated errors; where these hold it is about 0.8

struct PackOptions {
  Common common;
  fs::path beads, sample, bridges;
  bool generate = false;
};

/// Beads in another unit than µm differ from the sample's by powers of ten.
void check_unit(const PackOptions& options, const std::vector<Bead>& beads, const Sample& sample) {
  const double mean = mean_diameter(beads), expected = sample.beads.diameter;
  if (mean > 3.0 * expected || mean < expected / 3.0)
    bad_input(
        "{}: column diameter_um: found a mean of {:.4g}, expected about {:.4g} (beads.diameter_um of {}; "
        "wrong unit?)",
        options.beads.string(), 1e6 * mean, 1e6 * expected, options.sample.string());
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

std::vector<Bead> measured_beads(const PackOptions& options, const Sample& sample) {
  std::vector<Bead> beads = read_beads(options.beads);
  check_unit(options, beads, sample);
  if (diameters_used(sample, beads) == Diameters::measured) check_overlaps(beads, options.beads.string());
  return beads;
}

/// Their gaps change by as much as the beads were moved from where they were measured.
std::vector<Bridge> measured_bridges(const fs::path& path, const std::vector<Bead>& measured,
                                     const std::vector<Bead>& beads) {
  std::vector<Bridge> bridges = read_bridges(path, measured);
  std::erase_if(bridges, [](const Bridge& bridge) { return bridge.state != BridgeState::bridge; });
  if (bridges.empty())
    bad_input("{}: found no row in state bridge, expected measured bridges", path.string());
  for (auto& b : bridges) b.gap += gap(beads[b.i], beads[b.j]) - gap(measured[b.i], measured[b.j]);
  return bridges;
}

Packing packing_for(const PackOptions& options, const Sample& sample, const std::vector<Bead>& measured) {
  if (options.generate) {
    Packing packing = generate_packing(sample, options.common.seed);
    packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
    return packing;
  }
  Packing packing = packing_of(measured, sample);
  check_extent(packing);
  if (!options.bridges.empty()) packing.bridges = measured_bridges(options.bridges, measured, packing.beads);
  return packing;
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

nlohmann::ordered_json to_json(const Closing& closing) {
  return {{"pairs", closing.contacts},
          {"centre_rms_um", 1e6 * closing.centre_rms},
          {"diameter_rms_um", 1e6 * closing.diameter_rms},
          {"rms_over_stated_errors", closing.rms_over_errors}};
}

std::string use_in_words(const Sample& sample, Diameters diameters, const std::optional<Closing>& closed) {
  if (closed)
    return fmt::format(
        "diameters as measured: {} contacts closed by moving centres by {:.3f} um along each axis "
        "and changing diameters by {:.3f} um (rms; {:.2f} of the stated errors)",
        closed->contacts, 1e6 * closed->centre_rms, 1e6 * closed->diameter_rms, closed->rms_over_errors);
  if (diameters == Diameters::measured)
    return "diameters as they are: no errors are stated, no contacts closed";
  return fmt::format("diameters are drawn when compressed: {}", sample.beads.diameters == Diameters::automatic
                                                                    ? "no errors are stated"
                                                                    : "the sample asks for it");
}

void report(const PackingStatistics& s) {
  say(fmt::format("{} beads, mean diameter {:.2f} um, sd {:.2f} um", s.beads, 1e6 * s.mean_diameter,
                  1e6 * s.diameter_sd));
  say(fmt::format("{} bridges, {:.3f} +- {:.3f} per interior bead ({} of them)", s.bridges,
                  s.coordination.mean, s.coordination.standard_error, s.coordination.beads));
  say(fmt::format("volume fraction {:.4f}, in the core {:.4f}; {:.1f} % of neighbours touch",
                  s.volume_fraction, s.core_volume_fraction, 100.0 * s.touching_share));
}

void run(const PackOptions& options) {
  const fs::path& out = options.common.out;
  apply(options.common, {options.beads, options.sample, options.bridges}, {out, beside(out, ".json")});
  if (options.generate != options.beads.empty())
    throw BadUsage("pack: expected either beads.csv or --generate");
  if (options.generate && !options.bridges.empty())
    throw BadUsage("pack: --bridges goes with measured beads");
  if (out.extension() != ".vtp")
    throw BadUsage(fmt::format("pack: --out: found {}, expected a name ending in .vtp", out.string()));
  const Sample sample = read_sample(options.sample);
  const auto measured = options.generate ? std::vector<Bead>{} : measured_beads(options, sample);
  Packing packing = packing_for(options, sample, measured);
  std::vector<fs::path> inputs = {options.sample};
  for (const auto& input : {options.beads, options.bridges})
    if (!input.empty()) inputs.push_back(input);
  packing.provenance = provenance(options.common, inputs);

  const PackingStatistics statistics =
      packing_statistics(packing, sample.bridges.cutoff * sample.beads.diameter);
  nlohmann::ordered_json json = to_json(statistics);
  const Structure structure = structure_of(packing);
  if (!options.generate) check_scale(packing.beads, structure, sample);
  json["structure"] = to_json(structure);
  const Diameters diameters = diameters_used(sample, packing.beads);
  const auto closed = closing_of(sample, measured, packing);
  json["diameters"] = to_string(diameters);
  if (closed) json["closed_contacts"] = to_json(*closed);
  json["provenance"] = to_json(packing.provenance);
  WrittenTogether written;
  write_packing(out, packing);
  write_text(beside(out, ".json"), json.dump(2) + "\n");
  written.commit();
  report(statistics);
  say(use_in_words(sample, diameters, closed));
}

}  // namespace

void add_pack(CLI::App& app) {
  auto options = std::make_shared<PackOptions>();
  auto* command = app.add_subcommand(
      "pack",
      "Beads to a packing: bridges, coordination number, gaps, volume fraction.\n"
      "Bridges are the pairs with gaps below bridges.cutoff x beads.diameter_um of the sample, or those of "
      "state\n"
      "bridge in --bridges. The specimen has the sample's size, its axis in the middle of the beads' extent "
      "and\n"
      "its bottom at the lowest bead. The statistics are written beside the packing as .json.\n"
      "Where errors are stated (sigma_centre_um, sigma_diameter_um), beads that likely touch are moved and\n"
      "resized within these until they do, unless the sample has beads.diameters = \"drawn\".");
  command->add_option("beads", options->beads,
                      "beads.csv (bead_id,x_um,y_um,z_um,diameter_um,...; axes x, y, z)");
  command->add_option("--sample", options->sample, "Sample file (.toml)")->required();
  command->add_option("--bridges", options->bridges, "Measured bridges (bridges.csv) instead of candidates");
  command->add_flag("--generate", options->generate,
                    "Make a random packing from the sample instead of reading beads");
  add_common(*command, options->common, "Packing to write (.vtp)");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
