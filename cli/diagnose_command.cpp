#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/temporary_folder.h"
#include "cli/command.h"
#include "cli/run_making.h"
#include "diagnosis/diagnose.h"
#include "diagnosis/feature_values.h"
#include "diagnosis_report/report_folder.h"
#include "effects/list.h"
#include "viz/display.h"

namespace pendular::cli {
namespace {

struct Options {
  Common common;
  RunMaking making;
  fs::path file;
  bool dry_run = false, no_fresh_runs = false;
  int levels = 3, runs = diagnosis::BankOptions().runs;
  double confidence = diagnosis::Rules().confidence;
  std::vector<std::string> leave_out;
};

diagnosis::BankOptions bank_options(const Options& options) {
  diagnosis::BankOptions bank;
  bank.levels = options.levels;
  bank.runs = options.runs;
  for (const auto& id : options.leave_out) bank.leave_out.insert(effects::find_effect(id, "--leave-out").id);
  return bank;
}

std::vector<fs::path> inputs_of(const Options& options, const diagnosis::Experiment& experiment) {
  std::vector<fs::path> inputs = {options.file, experiment.sample_file};
  for (const auto& observation : experiment.observations) {
    inputs.push_back(observation.file);
    if (!observation.beads.empty() &&
        std::find(inputs.begin(), inputs.end(), observation.beads) == inputs.end())
      inputs.push_back(observation.beads);
  }
  return inputs;
}

void tell_cost(const Options& options, const diagnosis::Experiment& experiment) {
  const TemporaryFolder beads;
  const auto plan = diagnosis::plan_bank(experiment, bank_options(options), beads.path());
  say(fmt::format(
      "{} tests to simulate, {} runs to learn the effects from, then some {} to check the best explanation",
      plan.conditions.size(), plan.requests.size(), 8 * plan.conditions.size()));
  tell_work(options.making, options.common, plan.requests);
}

void run(const Options& options) {
  apply(options.common, {options.file});
  check(options.making);
  const auto experiment = diagnosis::read_experiment(options.file);
  diagnosis::require_features(experiment);
  protect_also(inputs_of(options, experiment));
  for (const auto& warning : experiment.warnings) warn(warning);
  if (options.dry_run) return tell_cost(options, experiment);
  const fs::path beads = options.making.store_folder(options.common) / "measured";
  const auto plan = diagnosis::plan_bank(experiment, bank_options(options), beads);
  make_folder(options.common.out);
  diagnosis::Rules rules;
  rules.confidence = options.confidence;
  auto found = diagnosis::diagnose(
      experiment, plan, beads,
      [&](const std::string& name, std::span<const sweep::RunRequest> requests) {
        return make_runs(options.making, options.common, name, requests);
      },
      rules, !options.no_fresh_runs);
  found.provenance = provenance(options.common, inputs_of(options, experiment));
  const viz::Display display;
  diagnosis_report::write_report_folder({options.common.out, display}, found);
  say(found.verdict);
}

}  // namespace

void add_diagnose(CLI::App& app) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "diagnose",
      "Where simulation and experiment part, which effect causes it, and how far it shrinks once that is "
      "added.\n"
      "Reads an experiment file with its observations; writes diagnosis.json, report.html, figures and "
      "tables.\n"
      "The same command goes on where it stopped; runs are kept and shared by content (--store).");
  command->add_option("file", options->file, "Experiment file (.toml)")->required();
  command->add_flag("--dry-run", options->dry_run, "Say how many runs there are and how long they take");
  command->add_flag("--no-fresh-runs", options->no_fresh_runs,
                    "Only say where and which; make no further runs that measure how far the gap shrinks");
  command
      ->add_option(
          "--levels", options->levels,
          "Magnitudes from which the response to an effect that draws is learnt; twice as many of others")
      ->check(CLI::Range(1, 6))
      ->capture_default_str();
  command
      ->add_option("--runs", options->runs,
                   "Most runs that are made, beside the first ones, at the explanations that lead")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command
      ->add_option("--confidence", options->confidence,
                   "How often the set of explanations is to hold the truth, as replayed runs show it")
      ->check(CLI::Range(0.5, 0.99))
      ->capture_default_str();
  command->add_option("--leave-out", options->leave_out, "Effects that are not considered, by their names")
      ->delimiter(',');
  add_run_making(*command, options->making);
  add_common(*command, options->common, "Folder for the report");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
