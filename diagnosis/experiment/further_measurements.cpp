#include "diagnosis/experiment/further_measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "diagnosis/experiment/believed.h"
#include "diagnosis/kinds/curve_signature.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
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
FurtherMeasurement of_kind(const Kind& kind, const std::string& name, double cost, const std::string& why) {
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
    for (double back = step; back <= depth; back += step)
      add(strain[k] - back, stress[k] * (1.0 - back / depth));
    for (double back = depth - step; back > 0.0; back -= step)
      add(strain[k] - back, stress[k] * (1.0 - back / depth));
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

std::vector<FurtherMeasurement> made() {
  const std::string polymer = "bridges.youngs_modulus_pa", height = "specimen.height_um";
  return {of_kind(kinds::lateral_strain(), "lateral strain at mid-height", 0.3,
                  "rearrangement and the ends show in it, a softer polymer does not"),
          of_kind(kinds::broken_bonds(), "acoustic events, or broken bridges, against strain", 0.3,
                  "when bonds break, and how many"),
          of_kind(kinds::coordination(), "bridges per bead, counted in a tomogram", 0.5,
                  "how many of the near pairs have a bridge"),
          of_kind(kinds::bridge_diameters(), "necks of sixty bridges, measured in a tomogram", 0.5,
                  "how thick bridges are, and how much they differ"),
          of_kind(kinds::bridge_gaps(), "gaps of sixty bridges, measured in a tomogram", 0.7,
                  "how far apart the beads of a bridge are"),
          of_kind(kinds::bridge_stiffness(), "twenty single bridges by micropipettes", 1.0,
                  "stiffness and course of a bridge without the network"),
          scan_at(0.01),
          scan_at(0.02),
          scan_at(0.05),
          {"unloading loops at 2, 4 and 6 % of strain",
           "damage lowers the unloading modulus, a softer law does not", 1.0, unloaded},
          of_another(height, kShorter, "a specimen of half the height",
                     "what sits at the ends or in the machine counts twice as much"),
          of_another(polymer, kStiffer, "a specimen with a polymer four times as stiff",
                     "a compliance in series counts four times as much, geometry as before"),
          {"another specimen, ten times as slowly", "only what takes time depends on the rate", 1.2, slower},
          {"the platens pressed on a steel block",
           "the compliance of frame and load cell by itself",
           0.2,
           nullptr,
           {"machine_compliance"}},
          {"a calibration sphere scanned with the specimen",
           "voxel size and the threshold's bias by themselves",
           0.3,
           nullptr,
           {"voxel_scale", "diameter_bias"}},
          {"sliding friction of two glued beads, and of a bead on the platen",
           "both coefficients by themselves",
           0.5,
           nullptr,
           {"bead_friction", "platen_friction"}},
          {"the simulation at half the speed",
           "the only one that needs no experiment",
           0.1,
           nullptr,
           {"loading_rate"}}};
}

}  // namespace

const std::vector<FurtherMeasurement>& further_measurements() {
  static const std::vector<FurtherMeasurement> all = made();
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
  make_folder(folder);
  Experiment experiment = beliefs;
  const fs::path table = folder / (beliefs.name + "_beads.csv");
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
