#pragma once

#include <string>
#include <vector>

#include "blind/case_folder.h"
#include "diagnosis/bank/runner.h"

namespace pendular::blind {

/// What the true effects of a case close of the gap, at their true magnitudes: what an answer that knows the
/// truth reaches with specimens that draw anew. Measured on the features on which the case's report measured
/// its own shrinkage (diagnosis::closed_by()), and written to REPORTS/NAME/oracle.json. Cases that withhold
/// no effect of the library, whose report measured no shrinkage, or that have the file already are left out.
/// Reads the sealed truth. `beads`: folder of measured beads beside the store. Returns the names of the cases
/// that were measured.
std::vector<std::string> measure_oracles(const CaseFolders& folders, const fs::path& reports,
                                         const fs::path& beads, const diagnosis::MakeRuns& make_runs);

}  // namespace pendular::blind
