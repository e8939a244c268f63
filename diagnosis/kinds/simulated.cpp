#include "diagnosis/kinds/simulated.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "packing/polydata.h"
#include "run_folder/run_folder.h"

namespace pendular::diagnosis {
namespace {

constexpr double kFrameStrain = 1e-4;  // a frame is written at the first step beyond its strain

Frame frame_of(const fs::path& path) {
  const RunFrame read = run_frame(read_polydata(path), path);
  Frame frame;
  frame.strain = read.strain, frame.stress = read.stress;
  frame.ids = read.ids;
  frame.displacement = read.displacement;
  for (std::size_t k = 0; k < read.position.size(); ++k)
    frame.rest.push_back(read.position[k] - read.displacement[k]);
  for (std::size_t k = 0; k < read.pairs.size(); ++k) {
    const PairOfIds pair = std::minmax(read.ids[static_cast<std::size_t>(read.pairs[k][0])],
                                       read.ids[static_cast<std::size_t>(read.pairs[k][1])]);
    if (read.lines[k] == RunFrame::Line::bond) frame.standing.push_back(pair);
    if (read.lines[k] == RunFrame::Line::broken) frame.broken.push_back(pair);
  }
  std::sort(frame.standing.begin(), frame.standing.end());
  std::sort(frame.broken.begin(), frame.broken.end());
  return frame;
}

}  // namespace

SimulatedTest read_simulated_test(const fs::path& folder) {
  SimulatedTest test;
  test.folder = folder;
  test.rows = read_curve(folder / run_file::kCurve, {&CurveRow::strain, &CurveRow::stress,
                                                     &CurveRow::broken_bonds, &CurveRow::lateral_strain});
  const fs::path file = folder / run_file::kResult;
  const RunResult result = read_result(file);
  if (!result.section || !result.height)
    bad_input("{}: specimen: found no section and height, expected those of a run", file.string());
  test.gauge = {*result.section, *result.height};
  for (const auto& path : frame_files(folder)) test.frames.push_back(frame_of(path));
  test.coordination = result.coordination.value_or(std::nan(""));
  return test;
}

void end_at(double strain, SimulatedTest& test) {
  const auto beyond = std::find_if(test.rows.begin(), test.rows.end(),
                                   [&](const CurveRow& row) { return row.strain > strain; });
  test.rows.erase(beyond, test.rows.end());
  std::erase_if(test.frames, [&](const Frame& frame) { return frame.strain > strain + kFrameStrain; });
}

void read_frames(const effects::Effect& effect, double theta, SimulatedTest& test) {
  for (auto& frame : test.frames) {
    std::vector<CurveRow> row(1);
    row.front().strain = frame.strain, row.front().stress = frame.stress;
    effect.rows(row, test.gauge, theta);
    frame.strain = row.front().strain;
    if (!effect.lengths) continue;
    for (auto* vectors : {&frame.rest, &frame.displacement})
      for (Vec3& v : *vectors) v *= effect.lengths(theta);
  }
}

void read_test(const effects::Effect& effect, double theta, SimulatedTest& test) {
  effect.rows(test.rows, test.gauge, theta);
  read_frames(effect, theta, test);
}

const Frame& frame_near(const SimulatedTest& test, double strain) {
  if (test.frames.empty()) bad_input("{}: found no frames", (test.folder / "frames").string());
  return *std::min_element(test.frames.begin(), test.frames.end(), [&](const Frame& a, const Frame& b) {
    return std::fabs(a.strain - strain) < std::fabs(b.strain - strain);
  });
}

Columns columns_of_rows(const SimulatedTest& test, const std::string& name, double CurveRow::*value) {
  Columns columns;
  auto &strains = columns["strain"], &values = columns[name];
  for (const auto& row : test.rows) {
    strains.push_back(row.strain);
    values.push_back(row.*value);
  }
  return columns;
}

double simulated_modulus(const SimulatedTest& test) {
  const auto found = dem_core::curve_features(test.rows);
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
