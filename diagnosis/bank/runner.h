#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/bank/feature_values.h"
#include "diagnosis/diagnosis.h"
#include "sweep/execute.h"

namespace pendular::diagnosis {

/// Makes a batch of runs, under a name that progress shows.
using MakeRuns = std::function<std::vector<sweep::RunOutcome>(const std::string& name,
                                                              std::span<const sweep::RunRequest> requests)>;

/// Books a run in the ledger, as what it was made `for`.
void book_run(const sweep::RunOutcome& outcome, std::size_t condition, const std::string& made_for,
              const Changes& changes, std::vector<LedgerRow>& ledger);

/// Reads a run that is done, as instruments do with these changes (request_of()); nothing where it failed.
std::shared_ptr<const SimulatedTest> read_run(const sweep::RunOutcome& outcome, const Changes& changes);

/// "baseline", "missing_bridges 0.1", "bridges.youngs_modulus_pa -2 sd".
std::string purpose_of(const Changes& changes);

}  // namespace pendular::diagnosis
