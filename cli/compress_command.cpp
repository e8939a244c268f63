#include <numeric>

#include "base/error.h"
#include "base/progress.h"
#include "cli/command.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "packing/measurement.h"
#include "packing/vtp.h"

namespace pendular::cli {
namespace {

struct CompressOptions {
  Common common;
  fs::path packing, sample;
  int realisations = 1;
  bool resume = false;
};

double number(const nlohmann::ordered_json& json, const char* outer, const char* inner) {
  return json.contains(outer) && json[outer].is_object() && json[outer][inner].is_number()
             ? json[outer][inner].get<double>()
             : std::numeric_limits<double>::quiet_NaN();
}

std::string in_words(const nlohmann::ordered_json& result) {
  const auto& limit = result["linear_limit_strain"];
  return fmt::format(
      "E = {:.2f} MPa, linear to {}, peak {:.3f} MPa at {:.2f} %, {} of {} bonds broken, "
      "work balance {:.1e}, diameters {}",
      1e-6 * number(result, "linear_modulus_pa", "value"),
      limit.is_number() ? fmt::format("{:.2f} %", 100.0 * limit.get<double>()) : "the end",
      1e-6 * number(result, "peak", "stress_pa"), 100.0 * number(result, "peak", "strain"),
      result["broken_bonds"].get<int>(), result["bonds"].get<int>(),
      number(result, "work_balance", "relative_error"),
      result["diameters"] == "drawn" ? "drawn" : "as in the packing");
}

/// Mean and standard deviation over realisations (paper: error bars of Figs. 4 and 5).
nlohmann::ordered_json ensemble(const std::vector<nlohmann::ordered_json>& results,
                                const Provenance& provenance) {
  const auto spread = [&](auto value) {
    std::vector<double> values;
    for (const auto& result : results)
      if (const double v = value(result); std::isfinite(v)) values.push_back(v);
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double square = 0.0;
    for (double v : values) square += (v - mean) * (v - mean);
    nlohmann::ordered_json json = {
        {"mean", mean}, {"sd", n > 1.0 ? std::sqrt(square / (n - 1.0)) : 0.0}, {"values", values}};
    return values.empty() ? nlohmann::ordered_json(nullptr) : json;
  };
  return {
      {"realisations", results.size()},
      {"linear_modulus_pa", spread([](const auto& r) { return number(r, "linear_modulus_pa", "value"); })},
      {"linear_limit_strain", spread([](const auto& r) {
         return r["linear_limit_strain"].is_number() ? r["linear_limit_strain"].template get<double>()
                                                     : std::numeric_limits<double>::quiet_NaN();
       })},
      {"peak_stress_pa", spread([](const auto& r) { return number(r, "peak", "stress_pa"); })},
      {"peak_strain", spread([](const auto& r) { return number(r, "peak", "strain"); })},
      {"provenance", to_json(provenance)}};
}

void run(const CompressOptions& options) {
  apply(options.common, {options.packing, options.sample});
  const Packing packing = read_packing(options.packing);
  const Sample sample = read_sample(options.sample);
  effects::check_effects(sample, options.sample.string());
  warn_of_open_contacts(packing.beads, sample);
  dem_core::CompressOptions compress_options;
  compress_options.resume = options.resume;
  compress_options.provenance = provenance(options.common, {options.packing, options.sample});
  if (options.realisations == 1) {
    const auto done = effects::compress_with_effects(packing, sample, options.common.seed, options.common.out,
                                                     compress_options);
    return say(in_words(done.result));
  }
  if (diameters_used(sample, packing.beads) == Diameters::measured)
    throw BadUsage(fmt::format(
        "--realisations: beads.diameters = \"{}\" takes them as measured, so that all realisations "
        "would be the same; expected \"drawn\" in {}",
        to_string(sample.beads.diameters), options.sample.string()));
  std::vector<nlohmann::ordered_json> results;
  make_folder(options.common.out);
  for (int k = 1; k <= options.realisations; ++k) {
    compress_options.provenance.seed = options.common.seed + static_cast<std::uint64_t>(k) - 1;
    const auto folder = options.common.out / fmt::format("realisation_{:02d}", k);
    make_inner_folder(folder);
    results.push_back(effects::compress_with_effects(packing, sample, compress_options.provenance.seed,
                                                     folder, compress_options)
                          .result);
    say(fmt::format("realisation {}: {}", k, in_words(results.back())));
  }
  compress_options.provenance.seed = options.common.seed;
  write_text(options.common.out / "result.json",
             ensemble(results, compress_options.provenance).dump(2) + "\n");
}

}  // namespace

void add_compress(CLI::App& app) {
  auto* command =
      app.add_subcommand("compress", "Uniaxial compression of a packing by the discrete element model");
  auto options = std::make_shared<CompressOptions>();
  command->add_option("packing", options->packing, "packing.vtp")->required();
  command->add_option("--sample", options->sample, "Sample file (TOML)")->required();
  command
      ->add_option("--realisations", options->realisations, "Runs with diameters drawn anew; seeds S, S+1, …")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_flag("--resume", options->resume, "Go on from the run folder's checkpoint");
  add_common(*command, options->common, "Run folder");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
