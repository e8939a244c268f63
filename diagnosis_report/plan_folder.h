#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis_report/report_folder.h"

namespace pendular::diagnosis_report {

/// Writes plan.json, next_experiments.csv and .png, and next_effects.csv into the desk's folder.
void write_plan_folder(const Desk& desk, const diagnosis::NextSteps& steps, const Provenance& provenance);

}  // namespace pendular::diagnosis_report
