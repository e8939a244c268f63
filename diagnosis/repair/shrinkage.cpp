#include "diagnosis/repair/shrinkage.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/distributions.h"
#include "base/random.h"
#include "diagnosis/experiment/specimens.h"
#include "diagnosis/words.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr int kFresh[] = {kFirstFresh, kFirstFresh + 1};
constexpr int kDraws = 1000;
constexpr const char* kModulus = "bridges.youngs_modulus_pa";

using Indices = std::vector<std::size_t>;
using Observations = std::set<std::size_t>;

Indices all_features(const Comparison& landmarks) {
  Indices all(landmarks.observed.features.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  return all;
}

/// √max(0, d²/p − noise): `noise` is what noise alone makes of d²/p.
double excess_of(const Eigen::LLT<Eigen::MatrixXd>& factor, const Eigen::VectorXd& values, double noise) {
  const double squared = values.dot(factor.solve(values));
  return std::sqrt(std::max(0.0, squared / static_cast<double>(values.size()) - noise));
}

/// The observations that features are read from.
Indices observations_of(const Comparison& landmarks, const Indices& features) {
  std::set<std::size_t> found;
  for (const std::size_t f : features) found.insert(landmarks.observed.observation[f]);
  return {found.begin(), found.end()};
}

/// One way of repairing the simulation: how magnitudes follow from some features.
struct Model {
  std::string name;
  std::function<Changes(const Indices&)> fit;
  Observations truly_strained = {};  ///< observations whose strains are the specimen's own
};

/// Tests of one member, and what was changed in them.
struct ChangedTests {
  Changes changes;
  SimulatedTests tests;
};

/// With what instruments make of them, and without.
struct MemberTests {
  ChangedTests by_machine, of_specimen;
};

/// Only the polymer's modulus, by generalised least squares on its logarithm, unbounded.
Changes retuned_modulus(const RepairInputs& inputs, const Indices& features) {
  const Comparison& landmarks = inputs.problem.landmarks;
  const auto found = std::find(landmarks.inputs.begin(), landmarks.inputs.end(), kModulus);
  if (found == landmarks.inputs.end()) return {};
  const auto column = static_cast<Eigen::Index>(found - landmarks.inputs.begin());
  const double relative =
      floating_inputs(inputs.experiment).at(kModulus) / sample_key(inputs.experiment.sample, kModulus);
  Gap gap = part_of(landmarks.gap, features);
  const Eigen::VectorXd response = gap.believed.col(column) / relative;  // of a change of log E_p by one
  gap.believed.col(column).setZero();
  const Eigen::LLT<Eigen::MatrixXd> factor(gap.covariance + gap.believed * gap.believed.transpose());
  const double weight = response.dot(factor.solve(response));
  if (!(weight > 0.0)) return {};
  const double change = std::clamp(response.dot(factor.solve(gap.values)) / weight, -2.5, 2.5);
  return {{kModulus, std::expm1(change) / relative}};
}

/// Which tests to withhold together: the features of each condition, or of each observation where there is
/// one condition only; what no test shows is never withheld.
std::vector<Indices> withheld_parts(const RepairInputs& inputs) {
  const Comparison& landmarks = inputs.problem.landmarks;
  std::set<std::size_t> tested;
  for (const auto& condition : inputs.plan.conditions)
    tested.insert(condition.observations.begin(), condition.observations.end());
  std::vector<std::set<std::size_t>> groups;
  for (const auto& condition : inputs.plan.conditions)
    groups.emplace_back(condition.observations.begin(), condition.observations.end());
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  if (groups.size() == 1) {
    groups.clear();
    for (const std::size_t index : tested) groups.push_back({index});
  }
  std::vector<Indices> parts;
  for (const auto& group : groups) {
    Indices part;
    for (std::size_t f = 0; f < landmarks.observed.features.size(); ++f)
      if (group.contains(landmarks.observed.observation[f])) part.push_back(f);
    if (!part.empty() && part.size() < landmarks.observed.features.size()) parts.push_back(part);
  }
  return parts;
}

/// Runs models on fresh members and compares.
class Bench {
 public:
  Bench(const RepairInputs& inputs, Diagnosis& diagnosis) : inputs_(inputs), diagnosis_(diagnosis) {}

  /// The gap that stays of some features with these changes: mean over the fresh members; the old one where
  /// nothing is shown. In the place of the others stands what it was. `truly_strained`: observations whose
  /// strains are the specimen's own, not the machine's.
  Eigen::VectorXd gap_with(const Changes& changes, const Observations& truly_strained,
                           const std::string& name, const Indices& features, bool overlay) {
    const auto needed = conditions_for(features);
    const Changes of_specimen = without_readings(changes);
    std::vector<sweep::RunRequest> requests;
    for (const int member : kFresh)
      for (const std::size_t c : needed)
        requests.push_back(request_of(inputs_.experiment, inputs_.plan.conditions[c], member,
                                      static_cast<std::uint64_t>(member), changes, inputs_.packings));
    const auto outcomes = inputs_.make_runs(name, requests);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(inputs_.problem.landmarks.gap.values.size()), count = sum;
    auto outcome = outcomes.begin();
    for (std::size_t m = 0; m < std::size(kFresh); ++m) {
      MemberTests member{{changes, SimulatedTests(inputs_.plan.conditions.size())}, {}};
      member.of_specimen = {of_specimen, member.by_machine.tests};
      for (const std::size_t c : needed) {
        book_run(*outcome, c, name + ": ", changes, diagnosis_.ledger);
        member.of_specimen.tests[c] = read_run(*outcome, of_specimen);
        member.by_machine.tests[c] = read_run(*outcome++, changes);
      }
      const Eigen::VectorXd values = features_of(member, truly_strained);
      for (Eigen::Index f = 0; f < values.size(); ++f)
        if (std::isfinite(values[f])) sum[f] += values[f], count[f] += 1.0;
      if (overlay) add_overlays(member, truly_strained);
    }
    Eigen::VectorXd gap = inputs_.problem.landmarks.gap.values;
    const Eigen::VectorXd observed = inputs_.problem.landmarks.observed.values();
    for (Eigen::Index f = 0; f < gap.size(); ++f)
      if (count[f] > 0.0) gap[f] = observed[f] - sum[f] / count[f];
    return gap;
  }

  /// The withheld features of all parts, each as the model that has not seen its part leaves it.
  Eigen::VectorXd withheld_gap(const Model& model, const std::vector<Indices>& parts,
                               const Indices& withheld) {
    Eigen::VectorXd gap = inputs_.problem.landmarks.gap.values;
    for (const auto& part : parts) {
      Indices others;
      for (const std::size_t f : all_features(inputs_.problem.landmarks))
        if (std::find(part.begin(), part.end(), f) == part.end()) others.push_back(f);
      const Eigen::VectorXd left =
          gap_with(model.fit(others), model.truly_strained, model.name + " on withheld data", part, false);
      for (const std::size_t f : part) gap[static_cast<Eigen::Index>(f)] = left[static_cast<Eigen::Index>(f)];
    }
    return gap(std::vector<Eigen::Index>(withheld.begin(), withheld.end()));
  }

 private:
  /// Tests that features are read from, those of single bridges aside.
  std::vector<std::size_t> conditions_for(const Indices& features) const {
    std::vector<std::size_t> needed;
    for (std::size_t c = 0; c < inputs_.plan.conditions.size(); ++c) {
      const auto& answers = inputs_.plan.conditions[c].observations;
      if (std::any_of(features.begin(), features.end(), [&](std::size_t f) {
            return std::find(answers.begin(), answers.end(),
                             inputs_.problem.landmarks.observed.observation[f]) != answers.end();
          }))
        needed.push_back(c);
    }
    return needed;
  }

  Eigen::VectorXd features_of(const MemberTests& member, const Observations& truly_strained) const {
    const ObservedFeatures& observed = inputs_.problem.landmarks.observed;
    const auto values_of = [&](const ChangedTests& changed) {
      return simulated_features(inputs_.experiment, inputs_.plan.conditions, observed, changed.tests,
                                changed.changes);
    };
    Eigen::VectorXd values = values_of(member.by_machine);
    if (truly_strained.empty()) return values;
    const Eigen::VectorXd true_values = values_of(member.of_specimen);
    for (Eigen::Index f = 0; f < values.size(); ++f)
      if (truly_strained.contains(observed.observation[static_cast<std::size_t>(f)]))
        values[f] = true_values[f];
    return values;
  }

  void add_overlays(const MemberTests& member, const Observations& truly_strained) {
    for (std::size_t index = 0; index < diagnosis_.overlays.size(); ++index) {
      const auto& [changes, tests] = truly_strained.contains(index) ? member.of_specimen : member.by_machine;
      if (auto columns =
              simulated_columns(inputs_.experiment, inputs_.plan.conditions, index, tests, changes))
        diagnosis_.overlays[index].repaired.push_back(std::move(*columns));
    }
  }

  const RepairInputs& inputs_;
  Diagnosis& diagnosis_;
};

/// The most probable single effect that is neither in the ambiguity set nor part of what is.
std::string wrong_effect_of(const Diagnosis& diagnosis) {
  std::set<std::string> named;
  for (const auto& id : diagnosis.ambiguity_set)
    for (const auto& effect : effects_in(id)) named.insert(effect);
  for (const auto& e : diagnosis.explanations)
    if (effects_in(e.id).size() == 1 && !named.contains(e.id) && !e.magnitudes.empty() &&
        e.reduced_chi_squared > 0.0)
      return e.id;
  return "";
}

std::vector<Eigen::Index> positions(const Indices& features) {
  return {features.begin(), features.end()};
}

/// The features on which all that is added is compared: those that can be withheld, in parts; where nothing
/// can, all.
struct Compared {
  std::vector<Indices> parts;
  Indices features;
};

Compared compared_features(const RepairInputs& inputs) {
  Compared compared{withheld_parts(inputs), {}};
  for (const auto& part : compared.parts)
    compared.features.insert(compared.features.end(), part.begin(), part.end());
  if (compared.parts.empty()) compared.features = all_features(inputs.problem.landmarks);
  return compared;
}

/// `left`: of the gap in the features that are compared.
Shrinkage shrinkage_on(const RepairInputs& inputs, const Compared& compared, const Eigen::VectorXd& left) {
  const Comparison& landmarks = inputs.problem.landmarks;
  Shrinkage found = shrinkage_of(part_of(landmarks.gap, compared.features), left);
  for (const std::size_t index : observations_of(landmarks, compared.features))
    found.observations.push_back(inputs.experiment.observations[index].name);
  return found;
}

/// Of two magnitudes of one effect, on the same features, that of all observations should close no less.
void warn_of_contradiction(Diagnosis& diagnosis) {
  const Shrinkage &fitted = diagnosis.fitted, &withheld = diagnosis.withheld;
  if (withheld.fraction <= fitted.interval_90.second) return;
  diagnosis.warnings.push_back(fmt::format(
      "with the magnitude that all observations ask for the cause closes less of the gap, {}, than with "
      "those that parts of them ask for, {}: the observations contradict each other about it",
      in_words(fitted), in_words(withheld)));
}

}  // namespace

Shrinkage shrinkage_of(const Gap& before, const Eigen::VectorXd& after) {
  const Eigen::MatrixXd covariance = before.covariance + before.believed * before.believed.transpose();
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  Shrinkage found;
  found.before = excess_of(factor, before.values, 1.0);
  found.after = excess_of(factor, after, 1.0);
  found.nothing_to_close = before.values.dot(factor.solve(before.values)) <=
                           chi_squared_quantile(0.95, static_cast<double>(before.values.size()));
  if (found.nothing_to_close) return found;
  const auto fraction = [](double was, double is) { return was > 0.0 ? 1.0 - is / was : 0.0; };
  found.fraction = fraction(found.before, found.after);
  std::vector<double> drawn;
  const Eigen::MatrixXd lower = factor.matrixL();
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd noise(after.size());
    for (Eigen::Index k = 0; k < noise.size(); ++k)
      noise[k] = random_normal(draw, static_cast<std::uint64_t>(k));
    noise = lower * noise;
    const double was = excess_of(factor, before.values + noise, 2.0);  // noise counts twice: seen and drawn
    drawn.push_back(fraction(was, excess_of(factor, after + noise, 2.0)));
  }
  std::sort(drawn.begin(), drawn.end());
  found.interval_90 = {drawn[kDraws / 20], drawn[kDraws - 1 - kDraws / 20]};
  return found;
}

Shrinkage shrinkage_by(const RepairInputs& inputs, const Changes& changes, Diagnosis& diagnosis) {
  const Compared compared = compared_features(inputs);
  const Eigen::VectorXd left =
      Bench(inputs, diagnosis).gap_with(changes, {}, "true effect", compared.features, false);
  return shrinkage_on(inputs, compared, left(positions(compared.features)));
}

const Explanation* to_add(const Diagnosis& diagnosis) {
  const Explanation& best = diagnosis.explanations.front();
  if (best.id != kUnknown && best.id != kOtherPairs) return best.magnitudes.empty() ? nullptr : &best;
  const auto& set = diagnosis.ambiguity_set;
  for (const auto& e : diagnosis.explanations)
    if (!e.magnitudes.empty() && std::find(set.begin(), set.end(), e.id) != set.end()) return &e;
  return nullptr;
}

void measure_shrinkage(const RepairInputs& inputs, Diagnosis& diagnosis) {
  const Problem& problem = inputs.problem;
  const Comparison& landmarks = problem.landmarks;
  const double excess_before = excess(landmarks.gap);
  diagnosis.fitted = {excess_before, excess_before, 0.0, {0.0, 0.0}, {}};
  diagnosis.withheld = diagnosis.fitted;
  const Explanation* added = to_add(diagnosis);
  if (!added || excess_before <= 0.0) return;
  const auto ids = effects_in(added->id);

  Bench bench(inputs, diagnosis);
  const Indices all = all_features(landmarks);
  const auto effect_model = [&](const std::string& name, const std::vector<std::string>& effects) {
    return Model{
        name,
        [&problem, &landmarks, effects](const Indices& features) {
          return changes_of(fitted_magnitudes(problem, effects, observations_of(landmarks, features)));
        },
        truly_strained(
            problem.readings,
            fitted_magnitudes(problem, effects, observations_of(landmarks, all_features(landmarks))))};
  };
  const Model best = effect_model("repaired", ids);
  const Compared compared = compared_features(inputs);
  const Eigen::VectorXd left = bench.gap_with(best.fit(all), best.truly_strained, best.name, all, true);
  diagnosis.fitted = shrinkage_on(inputs, compared, left(positions(compared.features)));
  if (compared.parts.empty()) return;
  const auto withheld = [&](const Model& model) {
    return shrinkage_on(inputs, compared, bench.withheld_gap(model, compared.parts, compared.features));
  };
  diagnosis.withheld = withheld(best);
  if (diagnosis.withheld.nothing_to_close) return;
  warn_of_contradiction(diagnosis);
  diagnosis.retuned =
      withheld(
          {"modulus retuned", [&](const Indices& features) { return retuned_modulus(inputs, features); }, {}})
          .fraction;
  diagnosis.wrong_effect = wrong_effect_of(diagnosis);
  if (!diagnosis.wrong_effect.empty())
    diagnosis.wrong = withheld(effect_model("wrong effect", {diagnosis.wrong_effect})).fraction;
}

}  // namespace pendular::diagnosis
