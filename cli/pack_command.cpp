#include <nlohmann/json.hpp>

#include <optional>

#include "base/error.h"
#include "base/progress.h"
#include "base/sample.h"
#include "cli/command.h"
#include "packing/pack.h"
#include "packing/tables.h"
#include "packing/vtp.h"

namespace pendular::cli {
namespace {

struct PackOptions {
  Common common;
  fs::path beads, sample, bridges;
  bool generate = false;
};

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

Packed made(const PackOptions& options, const Sample& sample) {
  if (options.generate) return pack_generated(sample, options.common.seed);
  const auto measured = read_beads(options.beads);
  std::optional<std::vector<Bridge>> bridges;
  if (!options.bridges.empty()) bridges = read_bridges(options.bridges, measured);
  return pack_beads(measured, bridges, sample,
                    {options.beads.string(), options.bridges.string(), options.sample.string()});
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
  Packed packed = made(options, sample);
  std::vector<fs::path> inputs = {options.sample};
  for (const auto& input : {options.beads, options.bridges})
    if (!input.empty()) inputs.push_back(input);
  packed.packing.provenance = provenance(options.common, inputs);
  nlohmann::ordered_json json = to_json(packed);
  json["provenance"] = to_json(packed.packing.provenance);
  WrittenTogether written;
  write_packing(out, packed.packing);
  write_text(beside(out, ".json"), json.dump(2) + "\n");
  written.commit();
  report(packed.statistics);
  say(use_in_words(sample, packed.diameters, packed.closed));
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
      "Where errors are stated (sigma_centre_um, sigma_diameter_um), beads are moved and resized by these "
      "until\n"
      "none overlap and as many touch as likely do, unless the sample has beads.diameters = \"drawn\".");
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
