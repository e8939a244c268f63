#pragma once

#include "base/files.h"
#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis_report {

/// Writes plan.json, next_experiments.csv, .png and .pdf, and next_effects.csv into a folder.
void write_plan_folder(const fs::path& out, const diagnosis::NextSteps& steps, const Provenance& provenance);

}  // namespace pendular::diagnosis_report
