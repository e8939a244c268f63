#include "diagnosis/bank/model_error.h"

#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {

double shared_stress_error(const Feature& feature) {
  for (const char* stress : {"modulus", "peak_stress", "stress_at"})
    if (feature.logarithm && feature.name.find(stress) != std::string::npos) return kThresholds.stress_error;
  return 0.0;
}

}  // namespace pendular::diagnosis
