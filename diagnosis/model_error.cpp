#include "diagnosis/model_error.h"

#include <map>

namespace pendular::diagnosis {
namespace {

constexpr double kOther = 0.05, kOtherDifference = 0.03;
constexpr double kSharedStress = 0.02;

const std::map<std::string, double>& errors() {
  static const std::map<std::string, double> all = {
      {"toe_strain", 1e-3},         {"toe_roundness", 0.1},
      {"early_modulus", 0.04},      {"linear_modulus", 0.015},
      {"linear_limit", 2.5e-3},     {"peak_strain", 2.5e-3},
      {"peak_stress", 0.02},        {"softening", 0.1},
      {"unloading_modulus", 0.02},  {"residual_strain", 1e-3},
      {"loop_area", 0.1},           {"lateral_ratio", 0.02},
      {"late_lateral_ratio", 0.06}, {"modulus_level", 0.02},
      {"modulus_exponent", 0.03},   {"modulus_beyond_funicular", 0.03},
      {"kn_level", 0.02},           {"kt_level", 0.02},
      {"kn_exponent", 0.05},        {"kt_exponent", 0.05},
      {"diameter_mean", 0.005},     {"diameter_spread", 0.005},
      {"gap_mean_um", 0.3},         {"coordination", 0.01},
      {"bulk_strain_share", 0.02},  {"radial_share", 0.03},
      {"tilt_share", 0.02},         {"wandering", 0.05},
      {"contact_gap_um", 0.0},      {"contact_variance_um2", 0.0},
      {"breaks_at_half", 0.4},      {"breaks_at_end", 0.2}};
  return all;
}

}  // namespace

double model_error(const Feature& feature) {
  // Later unloadings are read as the first one: their names end in _2, _3 …
  const auto end = feature.name.find_last_not_of("0123456789");
  const std::string name =
      end + 1 < feature.name.size() && feature.name[end] == '_' ? feature.name.substr(0, end) : feature.name;
  const auto found = errors().find(name);
  return found != errors().end() ? found->second : feature.logarithm ? kOther : kOtherDifference;
}

double shared_stress_error(const Feature& feature) {
  for (const char* stress : {"modulus", "peak_stress"})
    if (feature.logarithm && feature.name.find(stress) != std::string::npos) return kSharedStress;
  return 0.0;
}

}  // namespace pendular::diagnosis
