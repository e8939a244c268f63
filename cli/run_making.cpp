#include "cli/run_making.h"

#include "base/error.h"
#include "base/progress.h"

namespace pendular::cli {

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
                                         const std::string& name, const sweep::Plan& plan) {
  sweep::Store store(making.store_folder(common));
  sweep::ExecuteOptions how;
  how.cores = common.threads;
  how.retry_failed = making.retry_failed;
  if (making.executor == "slurm") how.slurm = sweep::SlurmOptions{making.slurm_options};
  Progress progress(name, 1.0);
  how.progress = [&](std::size_t done, std::size_t failed, std::size_t total) {
    progress.update(static_cast<double>(done + failed) / static_cast<double>(total),
                    fmt::format("{} of {} runs, {} failed", done + failed, total, failed));
  };
  return sweep::execute(store, plan.requests, how);
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
