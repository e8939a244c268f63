#include "diagnosis/simulated.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/error.h"
#include "micromechanics/stiffness.h"
#include "packing/polydata.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;

std::vector<CurveRow> read_rows(const fs::path& path) {
  const CsvTable table = read_csv(path, {"strain", "stress_pa", "broken_bonds", "lateral_strain"});
  const auto strain = table.numbers("strain"), stress = table.numbers("stress_pa"),
             broken = table.numbers("broken_bonds"), lateral = table.numbers("lateral_strain");
  std::vector<CurveRow> rows(table.rows());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].strain = strain[k], rows[k].stress = stress[k];
    rows[k].broken_bonds = broken[k], rows[k].lateral_strain = lateral[k];
  }
  return rows;
}

Columns column_pair(const SimulatedTest& test, const std::string& name, double CurveRow::*value) {
  Columns columns;
  for (const auto& row : test.rows) {
    columns["strain"].push_back(row.strain);
    columns[name].push_back(row.*value);
  }
  return columns;
}

/// The frame nearest to a strain.
PolyTable frame_at(const fs::path& folder, double strain) {
  PolyTable nearest;
  double distance = std::numeric_limits<double>::infinity();
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder / "frames")) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) {
    PolyTable frame = read_polydata(path);
    const double away = std::fabs(frame.number_fields.at("strain") - strain);
    if (away >= distance) continue;
    distance = away;
    nearest = std::move(frame);
  }
  if (nearest.points.empty()) bad_input("{}: found no frames", (folder / "frames").string());
  return nearest;
}

Columns displacements(const Observation& observation, const SimulatedTest& test) {
  const auto& strain = observation.column("strain");
  const double last = *std::max_element(strain.begin(), strain.end());
  const PolyTable frame = frame_at(test.folder, last);
  const double scale = last / frame.number_fields.at("strain");
  const auto ids = integers(frame, true, "bead_id", test.folder);
  const auto moved = vectors(frame, true, "displacement_um", test.folder);
  std::map<std::int64_t, bool> followed;
  if (!observation.beads.empty())
    for (std::size_t k = 0; k < strain.size(); ++k)
      if (strain[k] >= last * (1.0 - 1e-9))
        followed[static_cast<std::int64_t>(observation.column("bead_id")[k])] = true;
  Columns columns;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (!followed.empty() && !followed.contains(ids[k])) continue;
    const Vec3 start = frame.points[k] - moved[k], way = scale * moved[k];
    columns["strain"].push_back(last);
    columns["bead_id"].push_back(static_cast<double>(ids[k]));
    for (int axis = 0; axis < 3; ++axis) {
      const std::string letter(1, static_cast<char>('x' + axis));
      columns[letter + "_um"].push_back(start[axis]);
      columns["u" + letter + "_um"].push_back(way[axis]);
    }
  }
  return columns;
}

/// Numbers with this mean and standard deviation, as many as asked for: what a sample of them comes to.
std::vector<double> spread_about(double mean, double sd, std::size_t count) {
  const double n = static_cast<double>(count);
  std::vector<double> values;
  double square = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    values.push_back((static_cast<double>(k) + 0.5) / n - 0.5);
    square += values.back() * values.back();
  }
  const double scale = square > 0.0 ? sd / std::sqrt(square / (n - 1.0)) : 0.0;
  for (double& value : values) value = mean + scale * value;
  return values;
}

double magnitude(const Sample& sample, const std::string& effect) {
  const auto found = sample.effects.find(effect);
  return found == sample.effects.end() ? 0.0 : found->second;
}

/// Stiffness of bridges of a polymer of one pascal. Kept, because the runs of a diagnosis differ in E_p at
/// most, and all ask for the same bridges.
std::vector<BondStiffness> stiffness_per_pascal(const std::vector<BridgeBody>& bodies, double poisson_ratio) {
  static std::mutex guard;
  static std::map<std::vector<double>, std::vector<BondStiffness>> kept;
  std::vector<double> key = {poisson_ratio};
  for (const auto& body : bodies)
    key.insert(key.end(), {body.neck_diameter, body.gap, body.diameter_i, body.diameter_j});
  const std::lock_guard lock(guard);
  auto& found = kept[key];
  if (found.empty()) found = bridge_stiffnesses(bodies, {1.0, poisson_ratio}).bonds;
  return found;
}

/// What normal and tangential stiffness are over those by finite elements: one where none is stated.
std::pair<double, double> stated_over_finite_elements(const Sample& sample) {
  const auto& bridges = sample.bridges;
  if (!bridges.normal_stiffness) return {1.0, 1.0};
  const BondStiffness mean = stiffness_per_pascal({mean_bridge(sample)}, bridges.poisson_ratio).front();
  return {*bridges.normal_stiffness / (bridges.youngs_modulus * mean.normal),
          *bridges.tangential_stiffness / (bridges.youngs_modulus * mean.tangential)};
}

Columns tested_bridges(const Observation& observation, const Sample& sample) {
  const auto &d = observation.column("d_um"), &diameter = observation.column("D_um");
  std::vector<BridgeBody> bodies;
  for (std::size_t k = 0; k < d.size(); ++k)
    bodies.push_back({d[k] / kUm, sample.bridges.gap, diameter[k] / kUm, diameter[k] / kUm});
  const auto [normal, tangential] = stated_over_finite_elements(sample);
  const double modulus = sample.bridges.youngs_modulus;
  Columns columns = {{"d_um", d}, {"D_um", diameter}};
  for (const auto& bond : stiffness_per_pascal(bodies, sample.bridges.poisson_ratio)) {
    columns["kn_n_per_m"].push_back(normal * modulus * bond.normal);
    columns["kt_n_per_m"].push_back(tangential * modulus * bond.tangential);
  }
  return columns;
}

}  // namespace

SimulatedTest read_simulated_test(const fs::path& folder) {
  SimulatedTest test;
  test.folder = folder;
  test.rows = read_rows(folder / "curve.csv");
  const auto result = nlohmann::json::parse(read_text(folder / "result.json"), nullptr, false);
  if (result.is_discarded()) bad_input("{}: is damaged", (folder / "result.json").string());
  const auto& specimen = result.at("specimen");
  test.gauge = {1e-6 * specimen.at("section_mm2").get<double>(),
                1e-6 * specimen.at("height_um").get<double>()};
  const auto& z = result.at("coordination").at("bridges_per_interior_bead");
  test.coordination = z.is_number() ? z.get<double>() : std::nan("");
  return test;
}

Columns columns_of_test(const Observation& observation, const SimulatedTest& test) {
  switch (observation.kind) {
    case Kind::compression:
      return column_pair(test, "stress_pa", &CurveRow::stress);
    case Kind::lateral_strain:
      return column_pair(test, "lateral_strain", &CurveRow::lateral_strain);
    case Kind::broken_bonds:
      return column_pair(test, "count", &CurveRow::broken_bonds);
    case Kind::displacements:
      return displacements(observation, test);
    default:
      return {{"z", {test.coordination}}};
  }
}

double simulated_modulus(const SimulatedTest& test) {
  const auto found = pendular::curve_features(test.rows);
  return found ? found->modulus : std::nan("");
}

Columns columns_of_series(const Observation& observation, std::vector<SeriesPoint> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  const std::string at = observation.has("W") ? "W" : "E_p_pa";
  Columns columns = {{at, observation.column(at)}};
  for (double x : observation.column(at)) {
    std::size_t k = 1;
    while (k + 1 < points.size() && points[k].at < x) ++k;
    if (points.size() == 1) k = 0;
    const SeriesPoint &high = points[k], &low = points[k > 0 ? k - 1 : 0];
    const double share = k > 0 ? std::log(x / low.at) / std::log(high.at / low.at) : 0.0;
    columns["modulus_pa"].push_back(
        std::exp((1.0 - share) * std::log(low.modulus) + share * std::log(high.modulus)));
  }
  return columns;
}

Columns columns_of_bridges(const Observation& observation, const Sample& sample) {
  const auto& bridges = sample.bridges;
  if (observation.kind == Kind::bridge_stiffness) return tested_bridges(observation, sample);
  if (observation.kind == Kind::bridge_diameters) {
    const double spread = std::max(kUm * bridges.diameter_sd, magnitude(sample, "bridge_diameter_spread"));
    return {{"d_um", spread_about(kUm * bridges.diameter, spread, observation.rows())}};
  }
  return {{"gap_um", {kUm * bridges.gap + magnitude(sample, "bridge_gap_spread")}}};
}

}  // namespace pendular::diagnosis
