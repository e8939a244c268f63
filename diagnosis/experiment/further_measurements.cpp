#include "diagnosis/experiment/further_measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "diagnosis/experiment/believed.h"
#include "diagnosis/kinds/curve_signature.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "effects/list.h"
#include "packing/generate.h"
#include "packing/tables.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUsualStrain = 0.09;       // of a compression test where none was made
constexpr double kUsualCentreError = 3e-7;  // of a bead's centre and diameter in a scan, m
constexpr std::uint64_t kPlannedSeed = 1;   // of the specimen that a plan makes up
constexpr double kStiffer = 4.0, kShorter = 0.5, kSlower = 0.1;
constexpr double kReturn = 0.3;  // of the strain at a turn, by which a rough unloading goes back
const std::vector<double> kTurns = {0.02, 0.04, 0.06};

bool has(const Experiment& experiment, const Kind& kind) {
  return std::any_of(experiment.observations.begin(), experiment.observations.end(),
                     [&](const Observation& o) { return o.kind == &kind; });
}

/// Whether compression tests differ in what a function makes of their samples.
bool varied(const Experiment& experiment, const std::function<double(const Sample&)>& of) {
  std::set<double> found;
  for (const auto& o : experiment.observations)
    if (o.kind == &kinds::compression()) found.insert(of(experiment.sample_of(o)));
  return found.size() > 1;
}

double farthest_strain(const Experiment& experiment) {
  double farthest = 0.0;
  for (const auto& o : experiment.observations)
    if (o.has("strain")) farthest = std::max(farthest, last_strain(o));
  return farthest > 0.0 ? farthest : kUsualStrain;
}

/// The specimen that was looked at most: the beads and the settings of the first compression test.
const Observation* first_test(const Experiment& experiment) {
  for (const auto& o : experiment.observations)
    if (o.kind == &kinds::compression()) return &o;
  return nullptr;
}

std::string free_name(const Experiment& experiment, const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; std::any_of(experiment.observations.begin(), experiment.observations.end(),
                              [&](const Observation& o) { return o.name == name; });
       ++k)
    name = fmt::format("{}_{}", wanted, k);
  return name;
}

/// An observation of a kind with the kind's keys as they are where none is stated.
Observation bare(const Kind& kind, const std::string& name) {
  Observation observation;
  observation.kind = &kind, observation.name = name, observation.file = name;
  for (const auto& key : kind.keys) {
    if (key.words.empty())
      observation.numbers[key.name] = key.otherwise;
    else
      observation.words[key.name] = key.words.front();
  }
  return observation;
}

/// The experiment with one more observation of a kind, of the specimen of its first test.
Experiment with(const Experiment& experiment, const Kind& kind, double strain) {
  Experiment more = experiment;
  Observation observation = bare(kind, free_name(experiment, "planned_" + kind.name));
  if (const Observation* test = first_test(experiment))
    observation.set = test->set, observation.beads = test->beads;
  observation.columns = kind.planned(observation, more.sample_of(observation), strain);
  more.observations.push_back(std::move(observation));
  return more;
}

/// A kind that the experiment does not have yet.
FurtherMeasurement of_kind(const Kind& kind) {
  const auto& [name, why, cost] = *kind.usual;
  return {name, why, cost, [&kind](const Experiment& e) -> std::optional<Experiment> {
            if (has(e, kind)) return std::nullopt;
            return with(e, kind, farthest_strain(e));
          }};
}

/// A second specimen that differs in one key by a factor; its beads are not measured.
FurtherMeasurement of_another(const std::string& key, double factor, const std::string& name,
                              const std::string& why) {
  return {name, why, 1.0, [key, factor](const Experiment& e) -> std::optional<Experiment> {
            const auto value = [&](const Sample& sample) { return sample_key(sample, key); };
            if (varied(e, value)) return std::nullopt;
            Experiment more = with(e, kinds::compression(), farthest_strain(e));
            Observation& test = more.observations.back();
            test.set.emplace_back(key, factor * value(e.sample_of(test)));
            test.beads.clear();
            return more;
          }};
}

/// The test of another specimen, as slow as asked for.
std::optional<Experiment> slower(const Experiment& experiment) {
  const auto speed = [](const Sample& s) { return s.compression.speed_si.value_or(s.compression.speed); };
  if (varied(experiment, speed)) return std::nullopt;
  Experiment more = with(experiment, kinds::compression(), farthest_strain(experiment));
  Observation& test = more.observations.back();
  const Sample sample = experiment.sample_of(test);
  const std::string key = sample.compression.speed_si ? "compression.speed_mm_s" : "compression.speed";
  test.set.emplace_back(key, kSlower * sample_key(sample, key));
  test.beads.clear();
  return more;
}

/// Rows of a course that goes back at some strains and comes up again.
Columns with_returns(const Columns& columns, const std::vector<double>& turns) {
  const auto &strain = columns.at("strain"), &stress = columns.at("stress_pa");
  Columns course;
  const auto add = [&](double at, double value) {
    course["strain"].push_back(at), course["stress_pa"].push_back(value);
  };
  std::size_t next = 0;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    add(strain[k], stress[k]);
    if (next == turns.size() || strain[k] < turns[next]) continue;
    ++next;
    const double step = strain.front(), depth = kReturn * strain[k];
    const auto add_back = [&](double back) { add(strain[k] - back, stress[k] * (1.0 - back / depth)); };
    for (int row = 1; row * step <= depth; ++row) add_back(row * step);
    for (int row = 1; row * step < depth; ++row) add_back(depth - row * step);
  }
  return course;
}

/// The test of another specimen, with unloading, where none was unloaded.
std::optional<Experiment> unloaded(const Experiment& experiment) {
  for (const auto& o : experiment.observations)
    if (o.kind == &kinds::compression() &&
        !unloading_strains({o.column("strain"), o.column("stress_pa")}).empty())
      return std::nullopt;
  Experiment more = with(experiment, kinds::compression(), farthest_strain(experiment));
  Observation& test = more.observations.back();
  test.beads.clear();
  test.columns = with_returns(test.columns, kTurns);
  return more;
}

FurtherMeasurement scan_at(double strain) {
  return {fmt::format("a second scan at {:.0f} % of platen strain, its beads followed", 100.0 * strain),
          "the displacement of every bead, before chaos begins", 1.5,
          [strain](const Experiment& e) -> std::optional<Experiment> {
            const Observation* test = first_test(e);
            if (!test || test->beads.empty() || has(e, kinds::displacements()) || strain > farthest_strain(e))
              return std::nullopt;
            return with(e, kinds::displacements(), strain);
          }};
}

/// Kinds that an experiment may lack, the cheapest first.
void add_kinds(std::vector<FurtherMeasurement>& all) {
  for (const Kind* kind : all_kinds())
    if (kind->usual) all.push_back(of_kind(*kind));
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
}

/// More tests and scans.
void add_tests(std::vector<FurtherMeasurement>& all) {
  const std::string polymer = "bridges.youngs_modulus_pa", height = "specimen.height_um";
  const std::vector<FurtherMeasurement> tests = {
      scan_at(0.01),
      scan_at(0.02),
      scan_at(0.05),
      {"unloading loops at 2, 4 and 6 % of strain",
       "damage lowers the unloading modulus, a softer law does not", 1.0, unloaded},
      of_another(height, kShorter, "a specimen of half the height",
                 "what sits at the ends or in the machine counts twice as much"),
      of_another(polymer, kStiffer, "a specimen with a polymer four times as stiff",
                 "a compliance in series counts four times as much, geometry as before"),
      {"another specimen, ten times as slowly", "only what takes time depends on the rate", 1.2, slower}};
  all.insert(all.end(), tests.begin(), tests.end());
}

/// Those that are not of a specimen, each with all effects that it settles.
void add_direct(std::vector<FurtherMeasurement>& all) {
  const auto first = static_cast<std::ptrdiff_t>(all.size());
  for (const auto& effect : effects::all_effects()) {
    if (!effect.settled_by) continue;
    const auto& [name, why, cost] = *effect.settled_by;
    auto found = std::find_if(all.begin() + first, all.end(),
                              [&](const FurtherMeasurement& one) { return one.name == name; });
    if (found == all.end()) found = all.insert(all.end(), {name, why, cost});
    found->settles.insert(effect.id);
  }
}

}  // namespace

std::vector<FurtherMeasurement> further_measurements() {
  std::vector<FurtherMeasurement> all;
  add_kinds(all);
  add_tests(all);
  add_direct(all);
  return all;
}

Experiment planned_experiment(const Experiment& beliefs, const fs::path& folder) {
  std::vector<Bead> beads = generate_packing(beliefs.sample, kPlannedSeed).beads;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      beads[k].centre[axis] +=
          kUsualCentreError * random_normal(kPlannedSeed, 4 * k + static_cast<std::size_t>(axis));
    beads[k].diameter += kUsualCentreError * random_normal(kPlannedSeed, 4 * k + 3);
    beads[k].sigma_centre = beads[k].sigma_diameter = kUsualCentreError;
  }
  make_inner_folder(folder);
  Experiment experiment = beliefs;
  const fs::path table = folder / (sha256(sample_text(beliefs.sample)).substr(0, 16) + "_beads.csv");
  write_beads(table, beads, {});
  Observation test = bare(kinds::compression(), "compression");
  test.beads = table;
  test.columns = kinds::compression().planned(test, beliefs.sample, kUsualStrain);
  experiment.observations.push_back(std::move(test));
  experiment.contacts = contact_peak({read_beads(table)});
  return experiment;
}

void show(Observation& planned, const Columns& simulated) {
  planned.columns = planned.kind->shown(planned, simulated);
}

}  // namespace pendular::diagnosis
