#pragma once

#include <nlohmann/json_fwd.hpp>

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis_report {

/// The content of diagnosis.json (docs/diagnose.md). What is not known, or no
/// finite number, is null.
nlohmann::ordered_json to_json(const diagnosis::Diagnosis& diagnosis);

/// What a diagnosis of the experiment as it is would come to.
nlohmann::ordered_json to_json(const diagnosis::Outlook& outlook);

/// What could be measured next.
nlohmann::ordered_json to_json(const diagnosis::NextSteps& steps);

}  // namespace pendular::diagnosis_report
