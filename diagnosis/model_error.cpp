#include "diagnosis/model_error.h"

#include <map>

namespace pendular::diagnosis {
namespace {

constexpr double kOther = 0.05, kOtherDifference = 0.03;
constexpr double kSharedStress = 0.025;

const std::map<std::string, double>& errors() {
  static const std::map<std::string, double> all = {
      {"toe_strain", 2e-3},         {"toe_roundness", 0.15},
      {"early_modulus", 0.07},      {"linear_modulus", 0.025},
      {"linear_limit", 4e-3},       {"peak_strain", 4e-3},
      {"peak_stress", 0.03},        {"softening", 0.12},
      {"unloading_modulus", 0.04},  {"residual_strain", 2e-3},
      {"loop_area", 0.15},          {"lateral_ratio", 0.03},
      {"late_lateral_ratio", 0.08}, {"modulus_level", 0.025},
      {"modulus_exponent", 0.03},   {"modulus_beyond_funicular", 0.03},
      {"kn_level", 0.02},           {"kt_level", 0.02},
      {"kn_exponent", 0.05},        {"kt_exponent", 0.05},
      {"diameter_mean", 0.01},      {"diameter_spread", 0.01},
      {"gap_mean_um", 0.5},         {"coordination", 0.01},
      {"bulk_strain_share", 0.02},  {"radial_share", 0.03},
      {"tilt_share", 0.02},         {"wandering", 0.05},
      {"breaks_at_half", 0.5},      {"breaks_at_end", 0.25}};
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
