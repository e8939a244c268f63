#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "sweep/execute.h"

namespace pendular::python {

/// How the runs of a bank or a sweep are made.
struct RunTerms {
  fs::path store;
  fs::path program;  ///< pendular, for runs in processes of their own; empty: there is none
  bool retry_failed = false;
  int threads = 0;
  bool rows_suffice = false;  ///< see sweep::ExecuteOptions
};

/// The outcomes of runs, in the order of the requests. Those with an effect that was added in Python are made
/// in this process, one after the other, since no other process knows it; the rest as the command line makes
/// them, each in a process of its own.
std::vector<sweep::RunOutcome> make_runs(const RunTerms& terms, const std::string& name,
                                         std::span<const sweep::RunRequest> requests);

}  // namespace pendular::python
