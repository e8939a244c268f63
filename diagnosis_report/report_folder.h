#pragma once

#include "base/files.h"
#include "diagnosis/diagnosis.h"
#include "viz/display.h"

namespace pendular::diagnosis_report {

/// Where a report goes, and what draws it.
struct Desk {
  fs::path out;  ///< a folder; made where it is not there
  const viz::Display& display;
};

/// Writes diagnosis.json, report.html, every figure as a PNG file with the CSV of its numbers beside it, and
/// the tables as CSV (docs/diagnose.md). The same diagnosis gives the same bytes. BadInput where the folder
/// cannot be made; ComputationFailed where it cannot be written.
void write_report_folder(const Desk& desk, const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
