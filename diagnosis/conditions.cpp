#include "diagnosis/conditions.h"

#include <algorithm>

#include "diagnosis/believed.h"
#include "diagnosis/curve_signature.h"

namespace pendular::diagnosis {
namespace {

constexpr double kSeriesStrain = 0.06;          // shows the linear part
constexpr double kLongestStrain = 0.5;          // that a sample may ask for
constexpr double kLonger = 1.15, kToe = 0.005;  // room beyond the observed strain
constexpr double kSameUnloading = 1e-3;         // strains nearer than this are one unloading

/// Adds strains at which to unload, in order, none twice.
void add_unloadings(std::vector<double>& strains, const std::vector<double>& more) {
  for (double strain : more) {
    const auto near = [&](double other) { return std::abs(other - strain) < kSameUnloading; };
    if (std::none_of(strains.begin(), strains.end(), near)) strains.push_back(strain);
  }
  std::sort(strains.begin(), strains.end());
}

bool needs_test(Kind kind) {
  return kind != Kind::bridge_stiffness && kind != Kind::bridge_diameters && kind != Kind::bridge_gaps &&
         kind != Kind::modulus_series;
}

/// A sample without the course of its test: what must be equal for observations to share a run.
std::string without_course(Sample sample) {
  sample.compression.max_strain = 0.1;
  sample.compression.unload_at.clear();
  return sample_text(sample);
}

Condition condition_of(const Experiment& experiment, std::size_t index) {
  const Observation& observation = experiment.observations[index];
  Condition condition{experiment.sample_of(observation), observation.beads, {index}};
  if (!observation.has("strain")) {
    condition.sample.compression.max_strain = kSeriesStrain;
    return condition;
  }
  const auto& strain = observation.column("strain");
  condition.sample.compression.max_strain =
      std::min(kLongestStrain, kLonger * *std::max_element(strain.begin(), strain.end()) + kToe);
  if (observation.kind == Kind::compression)
    condition.sample.compression.unload_at = unloading_strains({strain, observation.column("stress_pa")});
  return condition;
}

void merge(std::vector<Condition>& all, Condition next) {
  for (auto& condition : all) {
    if (condition.beads != next.beads) continue;
    if (without_course(condition.sample) != without_course(next.sample)) continue;
    auto &course = condition.sample.compression, &longer = next.sample.compression;
    course.max_strain = std::max(course.max_strain, longer.max_strain);
    add_unloadings(course.unload_at, longer.unload_at);
    condition.observations.push_back(next.observations.front());
    return;
  }
  all.push_back(std::move(next));
}

void add_series(std::vector<Condition>& all, const Experiment& experiment, std::size_t index) {
  const Observation& observation = experiment.observations[index];
  const bool by_content = observation.has("W");
  const auto& at = observation.column(by_content ? "W" : "E_p_pa");
  for (std::size_t row = 0; row < at.size(); ++row) {
    const Sample sample = changed_sample(experiment.sample_of(observation), [&](Sample& changed) {
      if (by_content)
        set_polymer_content(changed, at[row]);
      else
        set_sample_key(changed, "bridges.youngs_modulus_pa", at[row]);
      changed.compression.max_strain = kSeriesStrain;
    });
    all.push_back({sample, observation.beads, {index}, row});
  }
}

}  // namespace

std::vector<Condition> conditions_of(const Experiment& experiment) {
  std::vector<Condition> tests, series;
  for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
    const Kind kind = experiment.observations[index].kind;
    if (needs_test(kind)) merge(tests, condition_of(experiment, index));
    if (kind == Kind::modulus_series) add_series(series, experiment, index);
  }
  tests.insert(tests.end(), series.begin(), series.end());
  return tests;
}

}  // namespace pendular::diagnosis
