#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "cli/command.h"
#include "cli/run_making.h"
#include "sweep/execute.h"
#include "sweep/make_run.h"
#include "sweep/tables.h"

namespace pendular::cli {
namespace {

struct SweepOptions {
  Common common;
  RunMaking making;
  bool seed_given = false;
  fs::path file;
  bool dry_run = false;
};

void run(const SweepOptions& options) {
  apply(options.common, {options.file});
  check(options.making);
  const auto seed = options.seed_given ? std::optional(options.common.seed) : std::nullopt;
  const sweep::SweepFile file = sweep::read_sweep(options.file, seed);
  const sweep::Plan plan = sweep::plan_of(file);
  if (options.dry_run) return tell_work(options.making, options.common, plan.requests);
  make_folder(options.common.out);
  std::vector<fs::path> inputs = {options.file, file.sample};
  if (!file.packing.empty()) inputs.push_back(file.packing);
  protect_also(inputs);
  Provenance from = provenance(options.common, inputs);
  from.seed = file.seed;

  const auto outcomes = make_runs(options.making, options.common, file.name, plan.requests);
  sweep::write_tables(options.common.out, plan, outcomes, from);
  if (const std::string failed = failures(outcomes); !failed.empty()) throw ComputationFailed(failed);
  say(fmt::format("{}: {} runs done, {}", file.name, outcomes.size(),
                  (options.common.out / "summary.csv").string()));
}

struct RunOptions {
  fs::path store;
  std::vector<std::string> hashes;
  int threads = 1;
};

void make_runs_of_store(const RunOptions& options) {
  set_threads(options.threads);
  if (!sweep::Store::exists(options.store))
    bad_input("{}: is no store of pendular sweep", options.store.string());
  sweep::Store store(options.store);
  if (options.hashes.size() == 1) return sweep::make_run(store, options.hashes.front());
  sweep::make_side_by_side(store, options.hashes);
}

}  // namespace

void add_sweep(CLI::App& app) {
  auto options = std::make_shared<SweepOptions>();
  auto* command = app.add_subcommand(
      "sweep",
      "Families of compressions: all combinations of a grid and of lists of keys, each in several "
      "realisations.\n"
      "Runs are made in parallel, kept once under the hash of their content, and gone on with by the same\n"
      "command; results.csv has a row per run, summary.csv one per point.");
  command->add_option("file", options->file, "Sweep file (.toml)")->required();
  command->add_flag("--dry-run", options->dry_run, "Say how many runs there are and how long they take");
  add_run_making(*command, options->making);
  add_common(*command, options->common, "Folder for the tables");
  command->callback([options, command] {
    options->seed_given = command->count("--seed") > 0;
    run(*options);
  });
}

void add_sweep_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  auto* command = app.add_subcommand("sweep-run", "Makes runs of a sweep's store")->group("");
  command->add_option("store", options->store)->required();
  command->add_option("hashes", options->hashes)->required();
  command->add_option("--threads", options->threads)->check(CLI::Range(1, 4096));
  command->callback([options] { make_runs_of_store(*options); });
}

}  // namespace pendular::cli
