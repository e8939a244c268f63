#include "run_folder/result.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pendular {
namespace {

using nlohmann::ordered_json;

/// A number by its path of keys; nothing where a key is missing or null. BadInput where it is something else.
std::optional<double> number(const ordered_json& json, const std::string& pointer, const fs::path& file) {
  const ordered_json::json_pointer at("/" + pointer);
  if (!json.contains(at) || json.at(at).is_null()) return std::nullopt;
  if (!json.at(at).is_number())
    bad_input("{}: {}: found {}, expected a number", file.string(), pointer, json.at(at).dump());
  return json.at(at).get<double>();
}

std::optional<Vec3> vector(const ordered_json& json, const std::string& pointer, const fs::path& file) {
  const auto x = number(json, pointer + "/0", file), y = number(json, pointer + "/1", file),
             z = number(json, pointer + "/2", file);
  if (!x || !y || !z) return std::nullopt;
  return Vec3(*x, *y, *z);
}

std::optional<ShearPlane> shear_band(const ordered_json& json, const fs::path& file) {
  if (!json.contains("shear_band") || !json["shear_band"].is_object()) return std::nullopt;
  if (!json["shear_band"].value("found", true)) return std::nullopt;
  const auto normal = vector(json, "shear_band/normal", file),
             point = vector(json, "shear_band/point_um", file);
  if (!normal || !point) return std::nullopt;
  if (!(normal->norm() > 0.0))
    bad_input("{}: shear_band/normal: found a null vector, expected a direction", file.string());
  ShearPlane band;
  band.normal = normal->normalized() * (normal->z() < 0.0 ? -1.0 : 1.0);
  band.point = *point * 1e-6;
  band.thickness = number(json, "shear_band/thickness_um", file).value_or(0.0) * 1e-6;
  band.contrast = number(json, "shear_band/contrast", file).value_or(0.0);
  return band;
}

std::optional<std::int64_t> count(const ordered_json& json, const std::string& key, const fs::path& file) {
  const auto value = number(json, key, file);
  if (!value) return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

}  // namespace

double ShearPlane::angle_to_axis() const {
  return std::asin(std::clamp(std::abs(normal.normalized().z()), 0.0, 1.0));
}

RunResult read_result(const fs::path& file) {
  const auto json = ordered_json::parse(read_text(file), nullptr, false);
  if (!json.is_object()) bad_input("{}: found no JSON object, expected the result of a run", file.string());
  RunResult result;
  result.modulus = number(json, "linear_modulus_pa/value", file);
  result.modulus_sigma = number(json, "linear_modulus_pa/sigma", file);
  result.toe = number(json, "fit/toe_strain", file).value_or(0.0);
  result.linear_limit = number(json, "linear_limit_strain", file);
  result.peak_strain = number(json, "peak/strain", file);
  result.peak_stress = number(json, "peak/stress_pa", file);
  result.band = shear_band(json, file);
  result.beads = count(json, "beads", file);
  result.bonds = count(json, "bonds", file);
  result.broken_bonds = count(json, "broken_bonds", file);
  result.coordination = number(json, "coordination/bridges_per_interior_bead", file);
  if (const auto height = number(json, "specimen/height_um", file)) result.height = 1e-6 * *height;
  if (const auto section = number(json, "specimen/section_mm2", file)) result.section = 1e-6 * *section;
  result.final_strain = number(json, "final_strain", file);
  result.inertial_number = number(json, "quasi_static/largest_inertial_number", file);
  result.unbalanced_force = number(json, "quasi_static/largest_unbalanced_force", file);
  result.work_balance_error = number(json, "work_balance/relative_error", file);
  if (json.contains("provenance")) result.provenance = json["provenance"];
  return result;
}

}  // namespace pendular
