#include <malloc.h>

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/temporary_folder.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "cli/picture_commands.h"
#include "cli/run_making.h"
#include "diagnosis/advice/planning.h"
#include "diagnosis/bank/feature_values.h"
#include "diagnosis/diagnose.h"
#include "diagnosis/experiment/further_measurements.h"
#include "diagnosis/words.h"
#include "diagnosis_report/plan_folder.h"
#include "diagnosis_report/report_folder.h"
#include "effects/list.h"

namespace pendular::cli {
namespace {

struct DiagnoseOptions {
  Common common;
  RunMaking making;
  fs::path file;
  bool dry_run = false, no_fresh_runs = false, plan = false;
  int levels = 3, runs = diagnosis::BankOptions().runs;
  double confidence = diagnosis::Rules().confidence;
  std::vector<std::string> leave_out, about;
};

diagnosis::BankOptions bank_options(const DiagnoseOptions& options) {
  diagnosis::BankOptions bank;
  bank.levels = options.levels;
  bank.runs = options.runs;
  for (const auto& id : options.leave_out) bank.leave_out.insert(effects::find_effect(id, "--leave-out").id);
  return bank;
}

std::vector<fs::path> inputs_of(const DiagnoseOptions& options, const diagnosis::Experiment& experiment) {
  std::vector<fs::path> inputs = {options.file, experiment.sample_file};
  for (const auto& observation : experiment.observations) {
    inputs.push_back(observation.file);
    if (!observation.beads.empty() &&
        std::find(inputs.begin(), inputs.end(), observation.beads) == inputs.end())
      inputs.push_back(observation.beads);
  }
  return inputs;
}

void tell_cost(const DiagnoseOptions& options, const diagnosis::Experiment& experiment) {
  const TemporaryFolder beads;
  const auto plan = diagnosis::plan_bank(experiment, bank_options(options), beads.path());
  say(fmt::format(
      "{} tests to simulate, {} runs to learn the effects from, then some {} to check the best explanation, "
      "and short ones of further scans if several are left",
      plan.conditions.size(), plan.requests.size(), 8 * plan.conditions.size()));
  tell_work(options.making, options.common, plan.requests);
}

diagnosis::MakeRuns maker(const DiagnoseOptions& options) {
  return [&options](const std::string& name, std::span<const sweep::RunRequest> requests) {
    return make_runs(options.making, options.common, name, requests);
  };
}

std::string in_words(const diagnosis::NextSteps& steps) {
  if (steps.now.cases == 0) return "the bank is too small to tell what measurements would bring";
  std::string words = fmt::format("A compression curve of a scanned specimen leaves {:.1f} explanations.",
                                  steps.now.set_size);
  if (steps.experiments.empty()) return words + " No measurement of the list tells more.";
  const auto& first = steps.experiments.front();
  return words + fmt::format(" Best value: {} ({}), which is expected to {}.", first.observation, first.why,
                             diagnosis::outlook_in_words(first.outlook, steps.now));
}

/// Before anything is measured.
void plan(const DiagnoseOptions& options, const diagnosis::Experiment& beliefs) {
  protect_also({beliefs.sample_file});
  std::set<std::string> about;
  for (const auto& id : options.about) about.insert(effects::find_effect(id, "--about").id);
  const TemporaryFolder scratch;
  const fs::path beads =
      options.dry_run ? scratch.path() : options.making.store_folder(options.common) / "measured";
  const auto planned = diagnosis::planned_experiment(beliefs, beads);
  if (options.dry_run) return tell_cost(options, planned);
  const auto bank = diagnosis::plan_bank(planned, bank_options(options), beads);
  diagnosis::Rules rules;
  rules.confidence = options.confidence;
  std::vector<diagnosis::LedgerRow> ledger;
  const auto steps = diagnosis::plan_experiments(planned, bank, beads, maker(options), about, rules, ledger);
  diagnosis_report::write_plan_folder(options.common.out, steps,
                                      provenance(options.common, {options.file, beliefs.sample_file}));
  say(in_words(steps));
}

void run(const DiagnoseOptions& options) {
  apply(options.common, {options.file});
  check(options.making);
  if (options.plan)
    if (const auto beliefs = diagnosis::read_beliefs(options.file)) return plan(options, *beliefs);
  const auto experiment = diagnosis::read_experiment(options.file);
  diagnosis::require_features(experiment);
  protect_also(inputs_of(options, experiment));
  for (const auto& warning : experiment.warnings) warn(warning);  // runs take minutes
  if (options.dry_run) return tell_cost(options, experiment);
  const fs::path beads = options.making.store_folder(options.common) / "measured";
  const auto bank = diagnosis::plan_bank(experiment, bank_options(options), beads);
  make_folder(options.common.out);
  diagnosis::Rules rules;
  rules.confidence = options.confidence;
  std::string cause;
  auto found = diagnosis::diagnose(
      experiment, bank, beads, maker(options), rules,
      {!options.no_fresh_runs, options.plan, [&](const std::string& words) { say(cause = words); }});
  say(found.verdict.substr(cause.size() + 1));
  ::malloc_trim(0);  // what runs took goes back: pictures need memory of their own
  found.provenance = provenance(options.common, inputs_of(options, experiment));
  diagnosis_report::write_report_folder(options.common.out, found);
  const auto& said = experiment.warnings;
  for (const auto& warning : found.warnings)
    if (std::find(said.begin(), said.end(), warning) == said.end()) warn(warning);
}

}  // namespace

void add_diagnose(CLI::App& app) {
  auto options = std::make_shared<DiagnoseOptions>();
  auto* command = add_picture_command(app, "diagnose");
  command->add_option("file", options->file, "Experiment file (.toml)")->required();
  command->add_flag("--dry-run", options->dry_run, "Say how many runs there are and how long they take");
  command->add_flag(
      "--no-fresh-runs", options->no_fresh_runs,
      "Only say where and which; make no further runs that measure how far the gap shrinks, or tell\n"
      "what further scans would show");
  auto* plan_flag =
      command->add_flag("--plan", options->plan,
                        "Make the runs that tell what further measurements would bring; of a sample, or an\n"
                        "experiment file without observations: before anything is measured");
  command
      ->add_option("--about", options->about,
                   "With --plan, before anything is measured: effects that are to be learnt about")
      ->needs(plan_flag)
      ->allow_extra_args(false)  // the file may follow
      ->delimiter(',');
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
      ->check(within(0.5, 0.99))
      ->capture_default_str();
  command->add_option("--leave-out", options->leave_out, "Effects that are not considered, by their names")
      ->delimiter(',');
  options->making.rows_suffice = true;
  add_run_making(*command, options->making);
  add_common(*command, options->common, "Folder for the report");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
