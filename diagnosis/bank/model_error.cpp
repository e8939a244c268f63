#include "diagnosis/bank/model_error.h"

namespace pendular::diagnosis {

double shared_stress_error(const Feature& feature) {
  constexpr double kShared = 0.01;
  for (const char* stress : {"modulus", "peak_stress", "stress_at"})
    if (feature.logarithm && feature.name.find(stress) != std::string::npos) return kShared;
  return 0.0;
}

}  // namespace pendular::diagnosis
