#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

#include "base/progress.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "dem_core/linear/linear_response_json.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "packing/measurement.h"
#include "packing/vtp.h"

namespace pendular::cli {
namespace {

struct ModulusOptions {
  Common common;
  fs::path packing, sample;
  double strain = 0.03;
};

std::string in_words(const dem_core::LinearResponse& response, double strain) {
  std::string text = fmt::format("E = {:.2f} MPa at {:.2f} % of platen strain, Poisson ratio {:.3f}",
                                 1e-6 * response.modulus, 100.0 * strain, response.poisson_ratio);
  for (const auto& reason : response.reasons) text += "\n  does not hold strictly: " + reason;
  return text;
}

void run(const ModulusOptions& options) {
  apply(options.common, {options.packing, options.sample}, {options.common.out});
  const Sample sample = read_sample(options.sample);
  effects::check_effects(sample, options.sample.string());
  const Packing packing = read_packing(options.packing);
  warn_of_open_contacts(packing.beads, sample);
  const auto specimen = effects::actual_specimen(packing, sample, options.common.seed);
  const dem_core::Simulation simulation = effects::actual_simulation(specimen);
  const dem_core::LinearResponse response = dem_core::linear_response(simulation, {options.strain});
  auto json = to_json(response, simulation, options.strain);
  json["diameters"] = to_string(specimen.sample.beads.diameters);
  json["provenance"] = to_json(provenance(options.common, {options.packing, options.sample}));
  write_text(options.common.out, json.dump(2) + "\n");
  say(in_words(response, options.strain));
}

}  // namespace

void add_modulus(CLI::App& app) {
  auto options = std::make_shared<ModulusOptions>();
  auto* command = app.add_subcommand(
      "modulus",
      "Young's modulus and Poisson ratio of a packing as a linear network of springs, without a DEM run,\n"
      "with the contacts that are closed at a strain of the platens, and whether the DEM may differ.");
  command->add_option("packing", options->packing, "packing.vtp")->required();
  command->add_option("--sample", options->sample, "Sample file (TOML)")->required();
  command
      ->add_option("--strain", options->strain, "Platen strain from first touch at which contacts are closed")
      ->check(within(1e-6, 0.2))
      ->capture_default_str();
  add_common(*command, options->common, "Result (.json)");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
