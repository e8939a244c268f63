#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/command.h"
#include "sweep/execute.h"
#include "sweep/request.h"

namespace pendular::cli {

/// How a command gets the runs of sweeps made, and where it keeps them.
struct RunMaking {
  fs::path store;
  bool retry_failed = false;
  bool rows_suffice = false;  ///< see sweep::ExecuteOptions
  std::string executor = "local", slurm_options;

  fs::path store_folder(const Common& common) const { return store.empty() ? common.out / "store" : store; }
};

/// Adds --store, --retry-failed, --resume, --executor and --slurm-options.
void add_run_making(CLI::App& command, RunMaking& making);

/// BadUsage where its options do not go together; call before any work.
void check(const RunMaking& making);

/// The outcomes of runs, with progress under `name`.
std::vector<sweep::RunOutcome> make_runs(const RunMaking& making, const Common& common,
                                         const std::string& name,
                                         std::span<const sweep::RunRequest> requests);

/// Says how many of some runs are left to make and how long they take, without making any.
void tell_work(const RunMaking& making, const Common& common, std::span<const sweep::RunRequest> requests);

/// What failed, in one line; empty where nothing did.
std::string failures(std::span<const sweep::RunOutcome> outcomes);

}  // namespace pendular::cli
