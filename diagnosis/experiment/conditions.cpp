#include "diagnosis/experiment/conditions.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem_core/simulation.h"
#include "diagnosis/experiment/believed.h"
#include "diagnosis/kinds/kind.h"
#include "effects/funicular.h"

namespace pendular::diagnosis {
namespace {

constexpr double kSeriesStrain = 0.06;          // shows the linear part
constexpr double kLongestStrain = 0.5;          // that a sample may ask for
constexpr double kLonger = 1.15, kToe = 0.005;  // room beyond the observed strain
constexpr double kSameUnloading = 1e-3;         // strains nearer than this are one unloading
constexpr double kSameScan = 1e-5;              // or one scan
// Courses are rounded to these steps, so that repeated measurements of a specimen share their runs.
constexpr double kStrainStep = 5e-3, kUnloadingStep = 2.5e-3;
constexpr double kBeyondScan = 1.005;       // of a scan's strain, at which its test ends
constexpr double kQuasiStatic = 1e-4;       // speed in model units below which inertia does not show
constexpr double kRelaxationStrain = 0.01;  // of the base sample, in its polymer's relaxation time

/// Adds strains, in order, none that is within `tolerance` of another.
void add_strains(std::vector<double>& strains, const std::vector<double>& more,
                 double tolerance = kSameUnloading) {
  for (double strain : more) {
    const auto near = [&](double other) { return std::abs(other - strain) < tolerance; };
    if (std::none_of(strains.begin(), strains.end(), near)) strains.push_back(strain);
  }
  std::sort(strains.begin(), strains.end());
}

/// A sample without the course of its test: what must be equal for observations to share a run.
std::string without_course(Sample sample) {
  sample.compression.max_strain = 0.1;
  sample.compression.unload_at.clear();
  sample.compression.frame_at.clear();
  return sample_text(sample);
}

std::vector<double> rounded(std::vector<double> strains) {
  for (double& strain : strains) strain = kUnloadingStep * std::round(strain / kUnloadingStep);
  std::vector<double> once;
  add_strains(once, strains);
  return once;
}

/// Diameters of measured beads are not drawn anew; nothing is shown that no observation asks for.
void set_course(Sample& sample, const Observation& observation) {
  if (!observation.beads.empty()) sample.beads.diameters = Diameters::measured;
  sample.observe = {false, false, false, false, false};
  sample.compression.frames = 0.0;
  sample.compression.frame_at.clear();
  sample.compression.max_strain = 0.0;
  if (observation.kind->course) observation.kind->course(observation, sample.compression);
}

/// Whether an experiment tells the rates of its tests apart.
bool states_rates(const Experiment& experiment) {
  for (const auto& observation : experiment.observations)
    for (const auto& [key, value] : observation.set)
      if (key == "compression.speed" || key == "compression.speed_mm_s") return true;
  return false;
}

/// A platen slower than quasi-static is simulated at that speed. The polymer's time, the same for all tests,
/// shortens with it.
void set_speed(Sample& sample, const Experiment& experiment) {
  const double stated = dem_core::platen_speed(sample);
  Sample slow = sample;
  slow.compression.speed = kQuasiStatic;
  slow.compression.speed_si = std::nullopt;
  const double simulated = std::max(stated, dem_core::platen_speed(slow));
  if (states_rates(experiment)) {
    const Sample& base = experiment.sample;
    const double time = base.bridges.relaxation_time.value_or(kRelaxationStrain * base.specimen.height /
                                                              dem_core::platen_speed(base));
    sample.bridges.relaxation_time = time * stated / simulated;
  }
  if (simulated > stated) sample.compression = slow.compression;
}

bool is_network(const Observation& observation) {
  return observation.kind == &kinds::bridges() && observation.words.at("use") == "simulate";
}

/// The measured bridges of a specimen that are to be simulated; empty: none.
fs::path network_of(const Experiment& experiment, const fs::path& beads) {
  for (const auto& observation : experiment.observations)
    if (is_network(observation) && observation.beads == beads) return observation.file;
  return {};
}

/// A specimen whose network was measured has it, and each bridge its own neck.
void set_network(Condition& condition, const Experiment& experiment) {
  condition.network = network_of(experiment, condition.beads);
  if (!condition.network.empty()) condition.sample.bridges.stiffness = StiffnessOf::per_bridge;
}

Condition condition_of(const Experiment& experiment, std::size_t index) {
  const Observation& observation = experiment.observations[index];
  Condition condition{experiment.sample_of(observation), observation.beads, {index}};
  set_network(condition, experiment);
  set_course(condition.sample, observation);
  set_speed(condition.sample, experiment);
  auto& course = condition.sample.compression;
  if (ends_at_scan(condition)) {
    std::vector<double> frames;
    add_strains(frames, course.frame_at, kSameScan);
    course.frame_at = frames;
    course.max_strain = std::min(kLongestStrain, kBeyondScan * frames.back());
    return condition;
  }
  course.unload_at = rounded(course.unload_at);
  if (course.max_strain == 0.0)
    course.max_strain = kSeriesStrain;
  else
    course.max_strain =
        std::min(kLongestStrain, kStrainStep * std::ceil((kLonger * course.max_strain + kToe) / kStrainStep));
  return condition;
}

void merge(std::vector<Condition>& all, Condition next) {
  for (auto& condition : all) {
    if (condition.beads != next.beads || ends_at_scan(condition) != ends_at_scan(next)) continue;
    if (without_course(condition.sample) != without_course(next.sample)) continue;
    auto &course = condition.sample.compression, &longer = next.sample.compression;
    course.max_strain = std::max(course.max_strain, longer.max_strain);
    add_strains(course.frame_at, longer.frame_at, kSameScan);
    add_strains(course.unload_at, longer.unload_at);
    condition.observations.push_back(next.observations.front());
    return;
  }
  all.push_back(std::move(next));
}

/// Rows of a series that are simulated: its ends, and in polymer content those on both sides of the funicular
/// transition. Between them the logarithm of E is interpolated (columns_of_series).
std::vector<std::size_t> supporting_rows(const std::vector<double>& at, bool by_content) {
  std::vector<std::size_t> order(at.size()), rows;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return at[a] < at[b]; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto beyond = [&](std::size_t n) {
      return by_content && at[order[n]] > effects::kFunicularContent;
    };
    const bool end = k == 0 || k + 1 == order.size();
    if (end || beyond(k) != beyond(k - 1) || beyond(k) != beyond(k + 1)) rows.push_back(order[k]);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

void add_series(std::vector<Condition>& all, const Experiment& experiment, std::size_t index) {
  const Observation& observation = experiment.observations[index];
  const bool by_content = observation.has("W");
  const auto& at = observation.column(by_content ? "W" : "E_p_pa");
  for (const std::size_t row : supporting_rows(at, by_content)) {
    const Sample sample = changed_sample(experiment.sample_of(observation), [&](Sample& changed) {
      set_course(changed, observation);
      set_speed(changed, experiment);
      if (by_content)
        set_polymer_content(changed, at[row]);
      else
        set_sample_key(changed, "bridges.youngs_modulus_pa", at[row]);
      changed.compression.max_strain = kSeriesStrain;
    });
    all.push_back({sample, observation.beads, {index}, row});
    set_network(all.back(), experiment);
  }
}

}  // namespace

bool ends_at_scan(const Condition& condition) {
  return !condition.sample.compression.frame_at.empty();
}

std::vector<Condition> conditions_of(const Experiment& experiment) {
  std::vector<Condition> tests, series;
  for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
    const Kind* kind = experiment.observations[index].kind;
    if (is_network(experiment.observations[index])) continue;
    if (kind->course) merge(tests, condition_of(experiment, index));
    if (kind == &kinds::modulus_series()) add_series(series, experiment, index);
  }
  tests.insert(tests.end(), series.begin(), series.end());
  return tests;
}

}  // namespace pendular::diagnosis
