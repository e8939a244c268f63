#pragma once

#include "base/process.h"
#include "blind/case_folder.h"

namespace pendular::blind {

/// How the cases of a folder are to be diagnosed.
struct DiagnoseRequest {
  fs::path store;              ///< of runs, which the cases share
  fs::path reports;            ///< REPORTS/NAME is the report of case NAME
  bool without_truth = false;  ///< leave each case's true effects out of the library; reads the sealed files
  /// Diagnoses one case: it is given the experiment file, -o REPORT, --store STORE, without the truth
  /// --leave-out IDS, and the options.
  Command diagnose;
  std::vector<std::string> options;
};

/// Diagnoses each case that has no report yet, one after the other; nothing of the truth is
/// read unless asked for. Returns the names of cases that failed, with what was said last. BadInput where the
/// folder has no case, or its reports are of the other way.
std::vector<std::string> diagnose_cases(const CaseFolders& folders, const DiagnoseRequest& request);

}  // namespace pendular::blind
