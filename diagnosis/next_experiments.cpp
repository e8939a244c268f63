#include "diagnosis/next_experiments.h"

#include <algorithm>
#include <functional>
#include <set>

#include "diagnosis/curve_signature.h"
#include "diagnosis/judgement.h"
#include "diagnosis/kinds/kind.h"

namespace pendular::diagnosis {
namespace {

constexpr double kSettled = 0.8;

bool has(const Experiment& experiment, const Kind& kind) {
  return std::any_of(experiment.observations.begin(), experiment.observations.end(),
                     [&](const Observation& o) { return o.kind == &kind; });
}

/// Whether observations of compression differ in what a function makes of their samples.
bool varied(const Experiment& experiment, const std::function<double(const Sample&)>& of) {
  std::set<double> found;
  for (const auto& o : experiment.observations)
    if (o.kind == &kinds::compression()) found.insert(of(experiment.sample_of(o)));
  return found.size() > 1;
}

bool unloads(const Experiment& experiment) {
  return std::any_of(experiment.observations.begin(), experiment.observations.end(),
                     [](const Observation& o) {
                       return o.kind == &kinds::compression() &&
                              !unloading_strains({o.column("strain"), o.column("stress_pa")}).empty();
                     });
}

/// A measurement, the effects whose presence it settles by itself, and what it costs in compression tests.
struct Candidate {
  std::string name;
  std::set<std::string> settles;
  double cost;
  std::string why;
  bool done;
};

std::vector<Candidate> candidates(const Experiment& experiment) {
  const bool followed = has(experiment, kinds::displacements());
  return {{"the platens pressed on a steel block",
           {"machine_compliance"},
           0.2,
           "the compliance of frame and load cell without a specimen",
           false},
          {"a specimen of half the height",
           {"machine_compliance", "platen_tilt", "platen_roughness"},
           1.0,
           "what sits at the ends or in the machine counts twice as much, what sits in the bridges the same",
           varied(experiment, [](const Sample& s) { return s.specimen.height; })},
          {"a specimen with a polymer four times as stiff",
           {"machine_compliance", "polymer_nonlinearity", "bead_friction", "platen_friction"},
           1.0,
           "a compliance in series grows with stiffness, geometry does not",
           varied(experiment, [](const Sample& s) { return s.bridges.youngs_modulus; }) ||
               has(experiment, kinds::modulus_series())},
          {"the same test ten times as fast",
           {"polymer_viscoelasticity", "loading_rate"},
           1.0,
           "only what takes time depends on the rate",
           varied(experiment,
                  [](const Sample& s) { return s.compression.speed_si.value_or(s.compression.speed); })},
          {"unloading loops at three strains",
           {"bond_damage", "polymer_nonlinearity", "polymer_viscoelasticity", "bead_friction"},
           0.5,
           "damage lowers the unloading modulus with the strain reached; a softer law does not",
           unloads(experiment)},
          {"lateral strain at mid-height",
           {"bridge_bending", "platen_friction", "bead_friction"},
           0.3,
           "rearrangement and the ends show in the lateral ratio, a softer polymer does not",
           has(experiment, kinds::lateral_strain())},
          {"twenty single bridges by micropipettes",
           {"polymer_nonlinearity", "bridge_bending", "polymer_viscoelasticity"},
           1.0,
           "stiffness and course of a bridge without the network",
           has(experiment, kinds::bridge_stiffness())},
          {"necks counted and measured in a tomogram",
           {"missing_bridges", "bridge_diameter_spread", "funicular_bridges"},
           0.7,
           "which candidate pairs have a bridge, and how thick it is",
           has(experiment, kinds::coordination()) && has(experiment, kinds::bridge_diameters())},
          {"gaps of bridged pairs from a tomogram at sub-voxel precision",
           {"bridge_gap_spread", "position_error"},
           0.7,
           "the mean excess gap by itself",
           has(experiment, kinds::bridge_gaps())},
          {"a second scan under load",
           {"machine_compliance", "platen_tilt", "platen_roughness", "residual_stress"},
           1.0,
           "strain inside the specimen against platen travel, and where it goes",
           followed},
          {"a calibration sphere scanned with the specimen",
           {"voxel_scale", "diameter_bias", "position_error"},
           0.3,
           "voxel size and the threshold's bias by themselves",
           false},
          {"sliding friction of two glued beads, and of a bead on the platen",
           {"bead_friction", "platen_friction"},
           0.5,
           "both coefficients by themselves",
           false},
          {"pull-off of single bridges",
           {"interface_strength", "bond_damage"},
           1.0,
           "the interfacial energy and how a bond goes, without the network",
           has(experiment, kinds::broken_bonds())},
          {"the simulation at half the speed", {"loading_rate"}, 0.1, "needs no experiment", false}};
}

/// Probability of the most probable explanation among those that stay.
double largest_share(const std::vector<Explanation>& explanations,
                     const std::function<bool(const Explanation&)>& stays) {
  double sum = 0.0, most = 0.0;
  for (const auto& e : explanations) {
    if (!stays(e)) continue;
    sum += e.probability;
    most = std::max(most, e.probability);
  }
  return sum > 0.0 ? most / sum : 0.0;
}

/// Which of a candidate's effects an explanation holds: what the measurement would find if it is the truth.
std::set<std::string> found_if(const Explanation& truth, const Candidate& candidate) {
  std::set<std::string> found;
  for (const auto& effect : effects_in(truth.id))
    if (candidate.settles.contains(effect)) found.insert(effect);
  return found;
}

double expected(const std::vector<Explanation>& explanations, const Candidate& candidate) {
  double resolved = 0.0;
  for (const auto& truth : explanations) {
    const auto found = found_if(truth, candidate);
    const double share =
        largest_share(explanations, [&](const Explanation& e) { return found_if(e, candidate) == found; });
    if (share >= kSettled) resolved += truth.probability;
  }
  return resolved;
}

}  // namespace

std::vector<NextExperiment> next_experiments(const Experiment& experiment,
                                             const std::vector<Explanation>& explanations) {
  const double now = largest_share(explanations, [](const Explanation&) { return true; });
  std::vector<NextExperiment> next;
  if (now >= kSettled) return next;
  for (const auto& candidate : candidates(experiment)) {
    if (candidate.done) continue;
    const double resolved = expected(explanations, candidate);
    if (resolved > 0.05) next.push_back({candidate.name, resolved, candidate.cost, candidate.why});
  }
  std::stable_sort(next.begin(), next.end(), [](const auto& a, const auto& b) {
    return a.expected_probability_resolved / (0.5 + a.cost) >
           b.expected_probability_resolved / (0.5 + b.cost);
  });
  return next;
}

}  // namespace pendular::diagnosis
