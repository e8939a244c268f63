#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/process.h"
#include "sweep/store.h"

namespace pendular::sweep {

/// How a batch system is asked for its nodes.
struct SlurmOptions {
  std::string sbatch;  ///< further options of sbatch, as typed in a shell
};

struct ExecuteOptions {
  int cores = 0;              ///< of this machine, shared between runs; 0: as many as threads may be used
  bool retry_failed = false;  ///< make runs anew that have failed before
  bool rows_suffice = false;  ///< runs that go farther than was asked answer, too: see RunOutcome::up_to
  std::optional<SlurmOptions> slurm;  ///< send the runs to Slurm instead
  /// Makes one run in a process of its own: it is given the store's folder, the run's hash, "--threads" and
  /// their number, calls make_run(), and ends with its error's status.
  Command worker;
  std::function<void(std::size_t done, std::size_t failed, std::size_t total)> progress;
};

/// What became of a run: done or failed.
struct RunOutcome {
  std::string hash;
  RunStatus status = RunStatus::waiting;
  int exit_status = 0;
  std::string message;  ///< of a failed run
  fs::path folder;      ///< of a run that is done
  /// The run goes farther: its rows and frames up to this strain are those asked for, its result is not.
  std::optional<double> up_to = {};
};

/// Makes the runs that the store does not have yet, waits for those that other processes make, and returns
/// the outcomes in the order of the requests. A run that has failed before stays failed. Interrupted where
/// the user stops it; every run that was being made then has a checkpoint.
std::vector<RunOutcome> execute(Store& store, std::span<const RunRequest> requests,
                                const ExecuteOptions& options);

}  // namespace pendular::sweep
