#pragma once

// The ways to get runs made. Internal to sweep.

#include <string>
#include <vector>

#include "sweep/execute.h"

namespace pendular::sweep {

/// Runs that are neither done nor failed yet, by the store's own word.
class OpenRuns {
 public:
  OpenRuns(Store& store, std::vector<std::string> hashes, const ExecuteOptions& options)
      : store_(store), hashes_(std::move(hashes)), options_(options) {
    ask();
  }

  /// Asks the store again, and shows progress.
  void ask();

  /// In the order given.
  const std::vector<RunRecord>& records() const { return records_; }

 private:
  Store& store_;
  std::vector<std::string> hashes_;
  const ExecuteOptions& options_;
  std::vector<RunRecord> records_;
};

/// Child processes of this one; returns when no run is open.
void run_locally(Store& store, OpenRuns& open, const ExecuteOptions& options);

/// A job array; the same.
void run_on_slurm(Store& store, OpenRuns& open, const ExecuteOptions& options);

}  // namespace pendular::sweep
