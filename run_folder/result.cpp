#include "run_folder/result.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pendular {
namespace {

using nlohmann::ordered_json;

constexpr double kMostUm = 1e7;      // no specimen is longer
constexpr double kMostStrain = 1e3;  // a line that is nearly flat meets zero stress far away
constexpr double kMostPa = 1e12;     // no solid is stiffer
constexpr double kMostRatio = 1e12;  // of forces or energies, where the smaller may be next to nothing
constexpr double kMostCount = 1e12;

/// Reads a result's numbers: by the path of keys, within a range. Nothing where a key is missing or null.
/// BadInput where there is something else.
struct Numbers {
  const ordered_json& json;
  const fs::path& file;

  std::optional<double> operator()(const std::string& pointer, double lowest, double highest) const {
    const ordered_json::json_pointer at("/" + pointer);
    if (!json.contains(at) || json.at(at).is_null()) return std::nullopt;
    const auto& found = json.at(at);
    if (!found.is_number() || !(found.get<double>() >= lowest && found.get<double>() <= highest))
      bad_input("{}: {}: found {}, expected a number from {:g} to {:g}", file.string(), pointer, found.dump(),
                lowest, highest);
    return found.get<double>();
  }

  std::optional<std::int64_t> count(const std::string& key) const {
    const auto value = (*this)(key, 0.0, kMostCount);
    if (!value) return std::nullopt;
    if (*value != std::floor(*value))
      bad_input("{}: {}: found {:g}, expected a whole number", file.string(), key, *value);
    return static_cast<std::int64_t>(*value);
  }

  std::optional<Vec3> vector(const std::string& pointer, double largest) const {
    const auto at = [&](const char* axis) { return (*this)(pointer + axis, -largest, largest); };
    const auto x = at("/0"), y = at("/1"), z = at("/2");
    if (!x || !y || !z) return std::nullopt;
    return Vec3(*x, *y, *z);
  }
};

std::optional<ShearPlane> shear_band(const Numbers& number) {
  const auto& json = number.json;
  if (!json.contains("shear_band") || !json["shear_band"].is_object()) return std::nullopt;
  const auto& found = json["shear_band"];
  if (found.contains("found") && found["found"] == false) return std::nullopt;
  const auto normal = number.vector("shear_band/normal", 1e3),
             point = number.vector("shear_band/point_um", kMostUm);
  if (!normal || !point) return std::nullopt;
  if (!(normal->norm() > 0.0))
    bad_input("{}: shear_band/normal: found a null vector, expected a direction", number.file.string());
  ShearPlane band;
  band.normal = normal->normalized() * (normal->z() < 0.0 ? -1.0 : 1.0);
  band.point = *point * 1e-6;
  band.thickness = number("shear_band/thickness_um", 0.0, kMostUm).value_or(0.0) * 1e-6;
  band.contrast = number("shear_band/contrast", 0.0, kMostRatio).value_or(0.0);
  return band;
}

}  // namespace

double ShearPlane::angle_to_axis() const {
  return std::asin(std::clamp(std::abs(normal.normalized().z()), 0.0, 1.0));
}

RunResult read_result(const fs::path& file) {
  const auto json = ordered_json::parse(read_text(file), nullptr, false);
  if (!json.is_object()) bad_input("{}: found no JSON object, expected the result of a run", file.string());
  RunResult result;
  const Numbers number{json, file};
  result.modulus = number("linear_modulus_pa/value", -kMostPa, kMostPa);
  result.modulus_sigma = number("linear_modulus_pa/sigma", 0.0, kMostPa);
  result.toe = number("fit/toe_strain", -kMostStrain, kMostStrain).value_or(0.0);
  result.linear_limit = number("linear_limit_strain", -kMostStrain, kMostStrain);
  result.peak_strain = number("peak/strain", -kMostStrain, kMostStrain);
  result.peak_stress = number("peak/stress_pa", -kMostPa, kMostPa);
  result.band = shear_band(number);
  result.beads = number.count("beads");
  result.bonds = number.count("bonds");
  result.broken_bonds = number.count("broken_bonds");
  result.coordination = number("coordination/bridges_per_interior_bead", 0.0, 1e3);
  if (const auto height = number("specimen/height_um", 1.0, kMostUm)) result.height = 1e-6 * *height;
  if (const auto section = number("specimen/section_mm2", 1e-6, 1e8)) result.section = 1e-6 * *section;
  result.final_strain = number("final_strain", -1.0, 1.0);
  result.inertial_number = number("quasi_static/largest_inertial_number", 0.0, kMostRatio);
  result.unbalanced_force = number("quasi_static/largest_unbalanced_force", 0.0, kMostRatio);
  result.work_balance_error = number("work_balance/relative_error", -kMostRatio, kMostRatio);
  if (json.contains("provenance")) result.provenance = json["provenance"];
  return result;
}

}  // namespace pendular
