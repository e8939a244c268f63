#pragma once

#include <span>

#include "base/provenance.h"
#include "sweep/execute.h"
#include "sweep/plan.h"

namespace pendular::sweep {

/// results.csv (one row per run, in the plan's order, failed ones with their message) and summary.csv (one
/// row per point: mean, standard deviation, standard error and number of values over the realisations that
/// have one) into a folder. They hold nothing that depends on where and when runs were made. BadInput where a
/// run's result cannot be read.
void write_tables(const fs::path& folder, const Plan& plan, std::span<const RunOutcome> outcomes,
                  const Provenance& provenance);

}  // namespace pendular::sweep
