#pragma once

#include <nlohmann/json.hpp>

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis_report {

/// The content of diagnosis.json (contract, "Report folder"; docs/diagnose.md). What is not known, or no
/// finite number, is null.
nlohmann::ordered_json to_json(const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
