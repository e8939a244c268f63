#pragma once

#include "base/files.h"
#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis_report {

/// Writes into a folder, which is made where it is not there: diagnosis.json, report.html, every figure
/// (drawn.h) with the CSV of its numbers beside it, and the tables as CSV (docs/diagnose.md). The same
/// diagnosis gives the same bytes. BadInput where the folder cannot be made; ComputationFailed where it
/// cannot be written or drawn.
void write_report_folder(const fs::path& out, const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
