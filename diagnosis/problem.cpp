#include "diagnosis/problem.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/median.h"
#include "base/random.h"
#include "diagnosis/field_readings.h"
#include "diagnosis/kinds/tools.h"
#include "diagnosis/law_readings.h"
#include "diagnosis/model_error.h"
#include "diagnosis/reduced_space.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kShown = 0.8;                 // of runs that must show a feature
constexpr double kBeyond = 1.15;               // how far beyond its bank an effect may go
constexpr double kScale = 0.5, kLeast = 0.12;  // usual and least magnitudes, over the bank's largest
// Of responses: a polynomial through three magnitudes is not the effect. Beads that were measured wrongly are
// only nearly found again.
constexpr double kError = 0.07, kErrorOfBeads = 0.4;
constexpr double kReading = 0.5;  // of what the other reading of a law does: one standard deviation of two that are alike
constexpr int kReadLevels = 6, kReadMembers = 3;  // of effects that only change what instruments read

std::string label(const ObservedFeatures& observed, std::size_t k) {
  return fmt::format("{}: {}", observed.features[k].observation, observed.features[k].name);
}

/// Mean of the rows that are finite, feature by feature.
Eigen::VectorXd mean_row(const std::vector<Eigen::VectorXd>& rows, Eigen::Index size) {
  Eigen::VectorXd mean = Eigen::VectorXd::Constant(size, std::nan(""));
  for (Eigen::Index f = 0; f < size; ++f) {
    double sum = 0.0, count = 0.0;
    for (const auto& row : rows)
      if (std::isfinite(row[f])) sum += row[f], count += 1.0;
    if (count > 0.0) mean[f] = sum / count;
  }
  return mean;
}

/// A bank and its tests.
struct Bank {
  BankPlan plan;
  std::vector<SimulatedTests> tests;
};

/// With what instruments would have made of the first baselines that have an effect on nothing but the reading.
Bank with_readings(const BankPlan& plan, const std::vector<SimulatedTests>& tests) {
  Bank bank{plan, tests};
  for (const auto& effect : effects::all_effects()) {
    if (!effect.reads_only() || plan.absent.contains(effect.id)) continue;
    for (int level = 1; level <= kReadLevels; ++level) {
      const double theta = kBeyond * effect.bank_to * level / kReadLevels;
      for (std::size_t k = 0; k < plan.points.size(); ++k) {
        DesignPoint point = plan.points[k];
        if (!point.id.empty() || point.whole == plan.scaled() || point.member > kReadMembers) continue;
        point.id = effect.id, point.theta = theta, point.changes = {{effect.id, theta}};
        SimulatedTests read = tests[k];
        for (auto& test : read)
          if (test) effect.rows(test->rows, test->gauge, theta), read_frames(effect, theta, *test);
        bank.plan.points.push_back(point);
        bank.tests.push_back(std::move(read));
      }
    }
  }
  return bank;
}

/// The effect that is changed, and nothing else; nullptr: none, a pair, or a believed input.
const effects::Effect* only_effect_in(const Changes& changes) {
  if (changes.size() != 1) return nullptr;
  const auto& all = effects::all_effects();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const auto& effect) { return effect.id == changes.begin()->first; });
  return found == all.end() ? nullptr : &*found;
}

/// A matrix whose product with its transpose is a covariance.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// Builds a comparison from the runs.
class Learner {
 public:
  Learner(Level level, const Experiment& experiment, const BankPlan& plan,
          const std::vector<SimulatedTests>& tests, std::vector<std::string>& warnings)
      : experiment_(experiment), plan_(plan), tests_(tests), warnings_(warnings) {
    found_.observed = observed_features(level, experiment);
    scaled_ = plan.scaled();
  }

  Comparison learn() {
    std::vector<Eigen::VectorXd> values;
    for (std::size_t k = 0; k < plan_.points.size(); ++k)
      values.push_back(simulated_features(experiment_, plan_.conditions, found_.observed, tests_[k],
                                          plan_.points[k].changes));
    by_noise_ = Eigen::VectorXd::Zero(size());
    if (found_.observed.level == Level::readings) add_fields(values);
    sort_runs(values);
    choose_shown();
    fit();
    return std::move(found_);
  }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(found_.observed.features.size()); }

  void add_fields(std::vector<Eigen::VectorXd>& values) {
    for (std::size_t index = 0; index < experiment_.observations.size(); ++index) {
      const auto fields = field_readings(experiment_, plan_, index, tests_);
      if (!fields) continue;
      auto& observed = found_.observed;
      const Eigen::Index before = size(), more = fields->by_noise.size();
      observed.features.insert(observed.features.end(), fields->observed.begin(), fields->observed.end());
      observed.observation.resize(observed.features.size(), index);
      const auto widen = [&](Eigen::MatrixXd& matrix, const Eigen::MatrixXd& block) {
        matrix.conservativeResizeLike(Eigen::MatrixXd::Zero(before + more, before + more));
        matrix.bottomRightCorner(more, more) = block;
      };
      widen(observed.measurement, Eigen::MatrixXd::Zero(more, more));  // simulated fields have the noise
      widen(observed.model, fields->model);
      by_noise_.conservativeResizeLike(Eigen::VectorXd::Zero(before + more));
      by_noise_.tail(more) = fields->by_noise;
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k].conservativeResize(before + more);
        values[k].tail(more) = fields->of_runs[k];
      }
    }
  }

  void sort_runs(std::vector<Eigen::VectorXd>& values) {
    for (std::size_t k = 0; k < plan_.points.size(); ++k) {
      const DesignPoint& point = plan_.points[k];
      if (point.whole && point.id.empty()) baselines_.push_back(values[k]);
      if (point.whole == scaled_) continue;
      const effects::Effect* effect = only_effect_in(point.changes);
      // What pairs leave is no scatter of the members either.
      const bool draws = point.changes.size() > 1 || (effect && effect->draws);
      design_.push_back({point.member, point.id, point.theta, std::move(values[k]), draws,
                         effect && effect->reads_only(), effect != nullptr});
      scans_only_.push_back(point.scans_only);
    }
  }

  void keep(const std::vector<std::size_t>& kept) {
    found_.observed = subset(found_.observed, kept);
    const std::vector<Eigen::Index> rows(kept.begin(), kept.end());
    by_noise_ = Eigen::VectorXd(by_noise_(rows));
    for (auto& values : baselines_) values = Eigen::VectorXd(values(rows));
    for (auto& run : design_) run.values = Eigen::VectorXd(run.values(rows));
  }

  void choose_shown() {
    std::vector<std::size_t> kept;
    const Eigen::VectorXd mean = mean_row(baselines_, size());
    for (std::size_t f = 0; f < found_.observed.features.size(); ++f) {
      const auto at = static_cast<Eigen::Index>(f);
      int shown = 0, asked = 0;
      for (std::size_t k = 0; k < design_.size(); ++k)
        if (!scans_only_[k]) ++asked, shown += std::isfinite(design_[k].values[at]);
      if (std::isfinite(mean[at]) && shown >= kShown * asked)
        kept.push_back(f);
      else if (found_.observed.level == Level::landmarks)
        warnings_.push_back(fmt::format("{} was observed but only {} of {} simulations show it; not used",
                                        label(found_.observed, f), shown, asked));
    }
    if (kept.empty())
      bad_input(
          "{}: found no feature that observations and simulations share, expected e.g. a compression that "
          "shows its linear part",
          experiment_.name);
    keep(kept);
  }

  void fit() {
    const Responses responses = fit_responses(design_, size());
    found_.simulated = mean_row(baselines_, size());
    found_.gap.values = found_.observed.values() - found_.simulated;
    set_signatures(responses);
    set_together(responses);
    set_believed(responses);
    set_covariance(responses);
    if (found_.observed.level == Level::readings) set_outside(responses);
  }

  void set_signatures(const Responses& responses) {
    for (const auto& effect : effects::all_effects()) {
      if (plan_.absent.contains(effect.id)) continue;
      const Signature* learnt = responses.find(effect.id);
      if (!learnt) continue;
      Signature signature = *learnt;
      signature.lowest = std::max(effect.lowest, kBeyond * effect.bank_from);
      signature.highest = std::min(effect.highest, kBeyond * effect.bank_to);
      const double largest = std::max(std::fabs(effect.bank_from), std::fabs(effect.bank_to));
      signature.scale = kScale * largest, signature.least = kLeast * largest;
      signature.error = effect.beads ? kErrorOfBeads : kError;
      found_.signatures.push_back(std::move(signature));
    }
  }

  /// Of the pairs that were run: what they do beyond the sum of their responses.
  void set_together(const Responses& responses) {
    for (const auto& point : plan_.points) {
      const Signature* both = responses.find(point.id);
      const bool known = std::any_of(found_.together.begin(), found_.together.end(),
                                     [&](const Together& t) { return t.a + "+" + t.b == point.id; });
      if (point.changes.size() != 2 || !both || known) continue;
      Together pair{point.changes.begin()->first, point.changes.rbegin()->first, point.changes.begin()->second,
                    point.changes.rbegin()->second, both->at(1.0)};
      for (const auto& signature : found_.signatures) {
        if (signature.id == pair.a) pair.beyond -= signature.at(pair.theta_a);
        if (signature.id == pair.b) pair.beyond -= signature.at(pair.theta_b);
      }
      found_.together.push_back(std::move(pair));
    }
  }

  void set_believed(const Responses& responses) {
    std::vector<Eigen::VectorXd> columns;
    const auto add = [&](const std::string& name, const Eigen::VectorXd& column) {
      found_.inputs.push_back(name);
      columns.push_back(column.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }));
    };
    for (const auto& [key, sd] : floating_inputs(experiment_))
      if (const Signature* found = responses.find(key)) {
        add(key, found->powers.front());
        // Of θ², whose standard deviation is √2.
        if (found->powers.size() > 1) add(key + kCurvature, M_SQRT2 * found->powers[1]);
      }
    for (const auto& reading : law_readings())
      if (const Signature* found = responses.find(reading.id)) add(reading.name, kReading * found->at(1.0));
    Eigen::VectorXd stresses(size());
    for (Eigen::Index f = 0; f < size(); ++f)
      stresses[f] = shared_stress_error(found_.observed.features[static_cast<std::size_t>(f)]);
    add(kSimulationError, stresses);
    const bool measured = std::any_of(plan_.conditions.begin(), plan_.conditions.end(),
                                      [](const Condition& c) { return !c.beads.empty(); });
    // The specimen is to the measured one as that is to those with further errors.
    if (measured && responses.offsets.rows() > 1)
      add(kBeadsError, responses.mean - responses.offsets.row(0).transpose());
    if (by_noise_.squaredNorm() > 0.0) add(kFieldError, by_noise_);
    found_.gap.believed = Eigen::MatrixXd(size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      found_.gap.believed.col(static_cast<Eigen::Index>(c)) = columns[c];
  }

  void set_covariance(const Responses& responses) {
    const Scatter scatter = scatter_of(responses);
    const auto& observed = found_.observed;
    found_.gap.covariance = scatter.covariance + positive_part(observed.measurement + observed.model);
    double share = 0.0;
    for (Eigen::Index f = 0; f < size(); ++f) {
      NoiseBudget budget;
      budget.ensemble = std::sqrt(scatter.covariance(f, f));
      budget.measurement = observed.sigma(static_cast<std::size_t>(f));
      budget.model = std::sqrt(observed.model(f, f));
      budget.believed = found_.gap.believed.row(f).norm();
      share += scatter.covariance(f, f) / found_.gap.covariance(f, f) / static_cast<double>(size());
      found_.noise.push_back(budget);
    }
    // Welch and Satterthwaite: only the ensemble's part of the noise was estimated.
    found_.gap.freedom = scatter.freedom / std::max(1e-6, share * share);
  }

  /// What the runs themselves have outside the span of the responses: those without an effect as it is, the
  /// others as a share of what their effect does within it.
  void set_outside(const Responses& responses) {
    const ReducedSpace space(found_.gap, found_.signatures);
    const auto& observed = found_.observed;
    const Eigen::MatrixXd noise = root_of(observed.measurement + observed.model);  // which runs do not have
    const auto outside = [&](const DesignRun& run) {
      Eigen::VectorXd drawn(size());
      for (Eigen::Index k = 0; k < size(); ++k)
        drawn[k] = random_normal(static_cast<std::uint64_t>(&run - design_.data()), static_cast<std::uint64_t>(k));
      return space.outside(run.values - responses.mean + noise * drawn);
    };
    for (const auto& run : design_)
      if (run.values.allFinite() && !signature_of(run.id) && run.id.find('+') == std::string::npos)
        found_.gap.outside.push_back(outside(run));
    if (found_.gap.outside.empty()) return;
    const double usual = median(found_.gap.outside);
    for (auto& signature : found_.signatures) {
      std::vector<double> shares;
      for (const auto& run : design_)
        if (run.id == signature.id && run.values.allFinite())
          shares.push_back(std::max(0.0, outside(run) - usual) /
                           (1.0 + space.reduced(run.values - responses.mean).squaredNorm()));
      if (!shares.empty()) signature.outside = std::max(signature.outside, std::sqrt(mean_of(shares)));
    }
  }

  const Signature* signature_of(const std::string& id) const {
    for (const auto& signature : found_.signatures)
      if (signature.id == id) return &signature;
    return nullptr;
  }

  const Experiment& experiment_;
  const BankPlan& plan_;
  const std::vector<SimulatedTests>& tests_;
  std::vector<std::string>& warnings_;
  Comparison found_;
  bool scaled_ = false;
  Eigen::VectorXd by_noise_;
  std::vector<DesignRun> design_;
  std::vector<bool> scans_only_;            // of its runs
  std::vector<Eigen::VectorXd> baselines_;  // of specimens of the observed size
};

}  // namespace

Problem problem_of(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests) {
  Problem problem;
  const Bank bank = with_readings(plan, tests);
  problem.landmarks = Learner(Level::landmarks, experiment, bank.plan, bank.tests, problem.warnings).learn();
  problem.readings = Learner(Level::readings, experiment, bank.plan, bank.tests, problem.warnings).learn();
  return problem;
}

Gap part_of(const Gap& gap, const std::vector<std::size_t>& features) {
  const std::vector<Eigen::Index> rows(features.begin(), features.end());
  Gap part;
  part.values = gap.values(rows);
  part.covariance = gap.covariance(rows, rows);
  part.believed = gap.believed(rows, Eigen::all);
  part.freedom = gap.freedom;
  return part;
}

std::vector<Signature> part_of(const std::vector<Signature>& signatures,
                               const std::vector<std::size_t>& features) {
  const std::vector<Eigen::Index> rows(features.begin(), features.end());
  std::vector<Signature> parts = signatures;
  const auto take = [&](Response& response) {
    for (auto& power : response.powers) power = Eigen::VectorXd(power(rows));
    if (response.draws.size() > 0) response.draws = Eigen::MatrixXd(response.draws(rows, rows));
  };
  for (auto& part : parts) {
    take(part);
    if (part.below) take(*part.below);
  }
  return parts;
}

std::vector<Together> part_of(const std::vector<Together>& together, const std::vector<std::size_t>& features) {
  const std::vector<Eigen::Index> rows(features.begin(), features.end());
  std::vector<Together> parts = together;
  for (auto& part : parts) part.beyond = Eigen::VectorXd(part.beyond(rows));
  return parts;
}

std::vector<std::size_t> features_from(const Comparison& comparison,
                                       const std::vector<std::size_t>& observations) {
  std::vector<std::size_t> features;
  for (std::size_t f = 0; f < comparison.observed.features.size(); ++f)
    if (std::find(observations.begin(), observations.end(), comparison.observed.observation[f]) !=
        observations.end())
      features.push_back(f);
  return features;
}

}  // namespace pendular::diagnosis
