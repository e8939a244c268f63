#include "diagnosis/kinds/simulated.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/error.h"
#include "packing/polydata.h"

namespace pendular::diagnosis {
namespace {

std::vector<CurveRow> read_rows(const fs::path& path) {
  const CsvTable table = read_csv(path, {"strain", "stress_pa", "broken_bonds", "lateral_strain"});
  const auto strain = table.numbers("strain"), stress = table.numbers("stress_pa"),
             broken = table.numbers("broken_bonds"), lateral = table.numbers("lateral_strain", true);
  std::vector<CurveRow> rows(table.rows());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].strain = strain[k], rows[k].stress = stress[k];
    rows[k].broken_bonds = broken[k], rows[k].lateral_strain = lateral[k];
  }
  return rows;
}

/// Vectors in µm to m.
std::vector<Vec3> in_m(std::vector<Vec3> all) {
  for (Vec3& one : all) one *= 1e-6;
  return all;
}

Frame read_frame(const fs::path& path) {
  constexpr std::int64_t kStanding = 0, kBroken = 1;
  const PolyTable table = read_polydata(path);
  Frame frame;
  frame.strain = table.number_fields.at("strain");
  frame.stress = table.number_fields.at("stress_pa");
  frame.ids = integers(table, true, "bead_id", path);
  frame.displacement = in_m(vectors(table, true, "displacement_um", path));
  frame.rest = in_m(table.points);
  for (std::size_t k = 0; k < frame.rest.size(); ++k) frame.rest[k] -= frame.displacement[k];
  const auto state = integers(table, false, "state", path);
  for (std::size_t k = 0; k < table.lines.size(); ++k) {
    const auto a = frame.ids[static_cast<std::size_t>(table.lines[k][0])],
               b = frame.ids[static_cast<std::size_t>(table.lines[k][1])];
    if (state[k] == kStanding) frame.standing.insert(std::minmax(a, b));
    if (state[k] == kBroken) frame.broken.insert(std::minmax(a, b));
  }
  return frame;
}

std::vector<Frame> read_frames(const fs::path& folder) {
  std::vector<fs::path> paths;
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Frame> frames;
  for (const auto& path : paths) frames.push_back(read_frame(path));
  return frames;
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
  test.frames = read_frames(folder / "frames");
  test.coordination = z.is_number() ? z.get<double>() : std::nan("");
  return test;
}

void read_frames(const effects::Effect& effect, double theta, SimulatedTest& test) {
  for (auto& frame : test.frames) {
    std::vector<CurveRow> row(1);
    row.front().strain = frame.strain, row.front().stress = frame.stress;
    effect.rows(row, test.gauge, theta);
    frame.strain = row.front().strain;
  }
}

const Frame& frame_near(const SimulatedTest& test, double strain) {
  if (test.frames.empty()) bad_input("{}: found no frames", (test.folder / "frames").string());
  return *std::min_element(test.frames.begin(), test.frames.end(), [&](const Frame& a, const Frame& b) {
    return std::fabs(a.strain - strain) < std::fabs(b.strain - strain);
  });
}

Columns columns_of_rows(const SimulatedTest& test, const std::string& name, double CurveRow::*value) {
  Columns columns;
  for (const auto& row : test.rows) {
    columns["strain"].push_back(row.strain);
    columns[name].push_back(row.*value);
  }
  return columns;
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

}  // namespace pendular::diagnosis
