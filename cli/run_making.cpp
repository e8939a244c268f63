#include "cli/run_making.h"

#include <map>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "cli/own_program.h"
#include "sweep/estimate.h"
#include "sweep/longer_runs.h"

namespace pendular::cli {
namespace {

std::string duration(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

/// What a store already has of a plan.
struct Stock {
  std::size_t done = 0, failed = 0;
  std::vector<sweep::RunRequest> left;  ///< to be made
  std::optional<double> rate;           ///< of the store's runs
};

Stock stock_of(const RunMaking& making, const Common& common, std::span<const sweep::RunRequest> requests) {
  const fs::path store_folder = making.store_folder(common);
  const bool retry_failed = making.retry_failed;
  std::vector<std::string> hashes;
  for (const auto& request : requests) hashes.push_back(sweep::content_hash(request));
  std::map<std::string, sweep::RunRecord> known;
  std::vector<std::optional<std::string>> longer(requests.size());
  Stock stock;
  if (sweep::Store::exists(store_folder)) {  // opening would make it
    sweep::Store store(store_folder);
    known = store.records(hashes);
    if (making.rows_suffice) longer = sweep::longer_runs(store, requests);
    stock.rate = store.rate();
  }
  for (std::size_t k = 0; k < hashes.size(); ++k) {
    const auto status = known[hashes[k]].status;
    const bool failed = status == sweep::RunStatus::failed;
    const bool done = longer[k] || status == sweep::RunStatus::done;
    stock.done += done;
    stock.failed += failed;
    if (done || (failed && !retry_failed)) continue;
    stock.left.push_back(requests[k]);
  }
  return stock;
}

}  // namespace

void add_run_making(CLI::App& command, RunMaking& making) {
  command.add_option("--store", making.store, "Folder of runs, which sweeps may share; default: OUT/store");
  command.add_flag("--retry-failed", making.retry_failed, "Make the runs again that failed before");
  command.add_flag("--resume")->description("Go on where it stopped; it does so anyway");
  command.add_option("--executor", making.executor, "Where runs are made: on this machine, or by Slurm")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  command.add_option("--slurm-options", making.slurm_options, "Further options of sbatch, in quotes");
}

void check(const RunMaking& making) {
  if (!making.slurm_options.empty() && making.executor != "slurm")
    throw BadUsage("--slurm-options: expected only with --executor slurm");
}

std::vector<sweep::RunOutcome> make_runs(const RunMaking& making, const Common& common,
                                         const std::string& name,
                                         std::span<const sweep::RunRequest> requests) {
  sweep::Store store(making.store_folder(common));
  sweep::ExecuteOptions how;
  how.worker = {own_program(), {"sweep-run"}};
  how.cores = common.threads;
  how.retry_failed = making.retry_failed;
  how.rows_suffice = making.rows_suffice;
  if (making.executor == "slurm") how.slurm = sweep::SlurmOptions{making.slurm_options};
  Progress progress(name, 1.0);
  how.progress = [&](std::size_t done, std::size_t failed, std::size_t total) {
    progress.update(static_cast<double>(done + failed) / static_cast<double>(total),
                    fmt::format("{} of {} runs, {} failed", done + failed, total, failed));
  };
  return sweep::execute(store, requests, how);
}

void tell_work(const RunMaking& making, const Common& common, std::span<const sweep::RunRequest> requests) {
  const auto [done, failed, left, rate] = stock_of(making, common, requests);
  say(fmt::format("{} runs: {} in the store, {} failed before, {} to make", requests.size(), done, failed,
                  left.size()));
  if (left.empty()) return;
  const auto work = sweep::estimate(left);
  const double cores = static_cast<double>(std::min(thread_count(), left.size()));
  const double per_core = rate.value_or(sweep::kStatedRate);
  say(fmt::format(
      "about {} on {} cores ({:.3g} particle-steps at {:.3g} M per second and core, {}), {:.2g} MB",
      duration(work.particle_steps / (per_core * cores)), cores, work.particle_steps, 1e-6 * per_core,
      rate ? "as the store's runs went" : "a guess until the store has runs", 1e-6 * work.bytes));
}

std::string failures(std::span<const sweep::RunOutcome> outcomes) {
  constexpr std::size_t kMostTold = 3;
  std::size_t failed = 0;
  std::string told;
  for (const auto& outcome : outcomes) {
    if (outcome.status != sweep::RunStatus::failed || ++failed > kMostTold) continue;
    told += fmt::format("; run {}: {}", outcome.hash.substr(0, 12), outcome.message);
  }
  if (failed == 0) return "";
  if (failed > kMostTold) told += "; …";
  return fmt::format("{} of {} runs failed, see results.csv (--retry-failed makes them again){}", failed,
                     outcomes.size(), told);
}

}  // namespace pendular::cli
