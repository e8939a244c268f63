#include "viz/run_folder.h"

#include <algorithm>
#include <cmath>

#include "base/csv.h"
#include "base/error.h"

namespace pendular::viz {
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

std::optional<ShearBand> shear_band(const ordered_json& json, const fs::path& file) {
  if (!json.contains("shear_band") || !json["shear_band"].is_object()) return std::nullopt;
  if (!json["shear_band"].value("found", true)) return std::nullopt;
  const auto normal = vector(json, "shear_band/normal", file),
             point = vector(json, "shear_band/point_um", file);
  if (!normal || !point) return std::nullopt;
  if (!(normal->norm() > 0.0))
    bad_input("{}: shear_band/normal: found a null vector, expected a direction", file.string());
  ShearBand band;
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
  result.coordination = number(json, "coordination/bridges_per_interior_bead", file);
  if (json.contains("provenance")) result.provenance = json["provenance"];
  return result;
}

std::vector<fs::path> sorted_entries(const fs::path& folder, const std::string& start,
                                     const std::string& extension) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(start, 0) == 0 && entry.path().extension() == extension) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

double ShearBand::angle_to_axis() const {
  return std::asin(std::clamp(std::abs(normal.normalized().z()), 0.0, 1.0));
}

RunFolder read_run_curves(const fs::path& path) {
  if (!fs::is_directory(path)) bad_input("{}: found no folder, expected a run folder", path.string());
  RunFolder run;
  run.path = path;
  const fs::path curve = path / "curve.csv";
  const CsvTable table = read_csv(curve, {"strain", "stress_pa"});
  if (table.rows() < 2) bad_input("{}: found {} rows, expected at least 2", curve.string(), table.rows());
  run.strain = table.numbers("strain");
  run.stress = table.numbers("stress_pa");
  if (fs::exists(path / "events.csv"))
    run.break_strain = read_csv(path / "events.csv", {"strain"}).numbers("strain");
  std::sort(run.break_strain.begin(), run.break_strain.end());
  run.result = read_result(path / "result.json");
  run.frames = sorted_entries(path / "frames", "frame_", ".vtp");
  return run;
}

RunFolder read_run_folder(const fs::path& path) {
  RunFolder run = read_run_curves(path);
  if (run.frames.empty())
    bad_input("{}: found no frame_*.vtp, expected at least one", (path / "frames").string());
  return run;
}

std::vector<fs::path> realisations(const fs::path& path) {
  if (!fs::is_directory(path)) bad_input("{}: found no folder, expected a run folder", path.string());
  if (fs::exists(path / "curve.csv")) return {path};
  auto found = sorted_entries(path, "realisation_", "");
  if (found.empty())
    bad_input("{}: found neither curve.csv nor realisation_* folders, expected a run folder", path.string());
  return found;
}

std::vector<fs::path> picture_inputs(const fs::path& path) {
  std::vector<fs::path> inputs;
  for (const fs::path& run : realisations(path))
    for (const char* name : {"curve.csv", "events.csv", "result.json", "frames"})
      if (fs::exists(run / name)) inputs.push_back(run / name);
  return inputs;
}

}  // namespace pendular::viz
