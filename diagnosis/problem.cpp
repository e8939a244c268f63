#include "diagnosis/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "diagnosis/contact_features.h"
#include "diagnosis/model_error.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr std::size_t kMostFeatures = 20;
constexpr double kShown = 0.8;                 // of runs that must show a feature
constexpr double kBeyond = 1.3;                // how far beyond its bank an effect may go
constexpr double kScale = 0.5, kLeast = 0.15;  // usual and least magnitudes, over the bank's largest
// Of responses: which bridges are missing is another matter than how many, and a polynomial through three
// magnitudes is not the effect. Beads that were measured wrongly are only nearly found again.
constexpr double kError = 0.1, kErrorOfBeads = 0.4;
constexpr int kReadLevels = 6, kReadDegree = 4;  // of effects that only change what instruments read

std::string label(const ObservedFeatures& observed, std::size_t k) {
  return fmt::format("{}: {}", observed.features[k].observation, observed.features[k].name);
}

/// Mean of the rows that are finite, feature by feature.
Eigen::VectorXd mean_of(const std::vector<Eigen::VectorXd>& rows, Eigen::Index size) {
  Eigen::VectorXd mean = Eigen::VectorXd::Constant(size, std::nan(""));
  for (Eigen::Index f = 0; f < size; ++f) {
    double sum = 0.0, count = 0.0;
    for (const auto& row : rows)
      if (std::isfinite(row[f])) sum += row[f], count += 1.0;
    if (count > 0.0) mean[f] = sum / count;
  }
  return mean;
}

/// Builds a problem from the runs.
class Learner {
 public:
  Learner(const Experiment& experiment, const BankPlan& plan, const std::vector<SimulatedTests>& tests)
      : experiment_(experiment), plan_(plan), tests_(tests) {
    problem_.observed = observed_features(experiment);
    scaled_ = std::any_of(plan.size.begin(), plan.size.end(), [](double size) { return size != 1.0; });
  }

  Problem learn() {
    read_runs();
    choose_shown();
    fit();
    choose_telling();
    return std::move(problem_);
  }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(problem_.observed.features.size()); }

  void read_runs() {
    for (std::size_t k = 0; k < plan_.points.size(); ++k) {
      const DesignPoint& point = plan_.points[k];
      Eigen::VectorXd values =
          simulated_features(experiment_, plan_.conditions, problem_.observed, tests_[k], point.changes());
      if (point.whole && point.id.empty()) {
        baselines_.push_back(values);
        baseline_points_.push_back(k);
      }
      if (point.whole != scaled_) design_.push_back({point.member, point.id, point.theta, std::move(values)});
    }
  }

  void keep(const std::vector<std::size_t>& kept) {
    problem_.observed = subset(problem_.observed, kept);
    const std::vector<Eigen::Index> rows(kept.begin(), kept.end());
    for (auto& values : baselines_) values = Eigen::VectorXd(values(rows));
    for (auto& run : design_) run.values = Eigen::VectorXd(run.values(rows));
  }

  void choose_shown() {
    std::vector<std::size_t> kept;
    const Eigen::VectorXd mean = mean_of(baselines_, size());
    for (std::size_t f = 0; f < problem_.observed.features.size(); ++f) {
      const auto at = static_cast<Eigen::Index>(f);
      const auto shown = std::count_if(design_.begin(), design_.end(),
                                       [&](const DesignRun& run) { return std::isfinite(run.values[at]); });
      if (std::isfinite(mean[at]) &&
          static_cast<double>(shown) >= kShown * static_cast<double>(design_.size()))
        kept.push_back(f);
      else
        problem_.warnings.push_back(
            fmt::format("{} was observed but only {} of {} simulations show it; not used",
                        label(problem_.observed, f), shown, design_.size()));
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
    problem_.simulated = mean_of(baselines_, size());
    problem_.gap.values = problem_.observed.values() - problem_.simulated;
    set_signatures(responses);
    set_believed(responses);
    set_covariance(responses);
  }

  void set_signatures(const Responses& responses) {
    for (const auto& effect : effects::all_effects()) {
      if (plan_.absent.contains(effect.id)) continue;
      const Signature* learnt = responses.find(effect.id);
      Signature signature = learnt ? *learnt : read_signature(effect);
      signature.lowest = std::max(effect.lowest, kBeyond * effect.bank_from);
      signature.highest = std::min(effect.highest, kBeyond * effect.bank_to);
      const double largest = std::max(std::fabs(effect.bank_from), std::fabs(effect.bank_to));
      signature.scale = kScale * largest, signature.least = kLeast * largest;
      signature.error = effect.beads ? kErrorOfBeads : kError;
      problem_.signatures.push_back(std::move(signature));
    }
  }

  /// Of an effect that only changes what instruments read: from the baselines, read otherwise.
  Signature read_signature(const effects::Effect& effect) {
    std::vector<double> thetas;
    std::vector<Eigen::VectorXd> changes;
    for (int level = 1; level <= kReadLevels; ++level) {
      const double theta = kBeyond * effect.bank_to * level / kReadLevels;
      std::vector<Eigen::VectorXd> rows;
      for (std::size_t b = 0; b < baselines_.size(); ++b) {
        SimulatedTests read = tests_[baseline_points_[b]];
        for (auto& test : read)
          if (test) effect.rows(test->rows, test->gauge, theta);
        rows.push_back(
            simulated_features(experiment_, plan_.conditions, problem_.observed, read, {{effect.id, theta}}) -
            baselines_[b]);
      }
      thetas.push_back(theta);
      changes.push_back(mean_of(rows, size()).unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }));
    }
    return exact_signature(effect.id, thetas, changes, kReadDegree);
  }

  void set_believed(const Responses& responses) {
    std::vector<Eigen::VectorXd> columns;
    const auto add = [&](const std::string& name, const Eigen::VectorXd& column) {
      problem_.inputs.push_back(name);
      columns.push_back(column);
    };
    for (const auto& [key, sd] : floating_inputs(experiment_))
      if (const Signature* found = responses.find(key)) add(key, found->at(1.0));
    Eigen::VectorXd stresses(size());
    for (Eigen::Index f = 0; f < size(); ++f)
      stresses[f] = shared_stress_error(problem_.observed.features[static_cast<std::size_t>(f)]);
    add(kSimulationError, stresses);
    const bool measured = std::any_of(plan_.conditions.begin(), plan_.conditions.end(),
                                      [](const Condition& c) { return !c.beads.empty(); });
    if (measured && responses.offsets.rows() > 1) {
      const Eigen::Index moved = responses.offsets.rows() - 1;
      add(kBeadsError, responses.offsets.bottomRows(moved).colwise().mean().transpose() -
                           responses.offsets.row(0).transpose());
    }
    problem_.gap.believed = Eigen::MatrixXd(size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      problem_.gap.believed.col(static_cast<Eigen::Index>(c)) = columns[c];
  }

  void set_covariance(const Responses& responses) {
    const Scatter scatter = scatter_of(responses);
    problem_.gap.covariance = scatter.covariance;
    double share = 0.0;
    for (Eigen::Index f = 0; f < size(); ++f) {
      const auto& feature = problem_.observed.features[static_cast<std::size_t>(f)];
      NoiseBudget budget;
      budget.ensemble = std::sqrt(scatter.covariance(f, f));
      budget.measurement = problem_.observed.sigmas[static_cast<std::size_t>(f)];
      budget.model = model_error(feature);
      budget.believed = problem_.gap.believed.row(f).norm();
      problem_.noise.push_back(budget);
      problem_.gap.covariance(f, f) += std::pow(budget.measurement, 2) + std::pow(budget.model, 2);
      share += scatter.covariance(f, f) / problem_.gap.covariance(f, f) / static_cast<double>(size());
    }
    // Only this share of the variance was estimated from runs (Satterthwaite).
    problem_.gap.freedom = scatter.freedom / std::max(1e-6, share * share);
  }

  void choose_telling() {
    const auto count = problem_.observed.features.size();
    if (count <= kMostFeatures) return;
    std::vector<std::pair<double, std::size_t>> moved;
    for (std::size_t f = 0; f < count; ++f) {
      const auto at = static_cast<Eigen::Index>(f);
      double most = problem_.gap.believed.row(at).cwiseAbs().maxCoeff();
      for (const auto& signature : problem_.signatures)
        most = std::max(most, std::fabs(signature.at(signature.scale)[at]));
      moved.emplace_back(-most / std::sqrt(problem_.gap.covariance(at, at)), f);
      if (is_of_beads(problem_.observed.features[f]))
        moved.back().first = -HUGE_VAL;  // nothing else tells that
    }
    std::sort(moved.begin(), moved.end());
    std::vector<std::size_t> kept;
    std::string left_out;
    for (std::size_t k = 0; k < count; ++k) {
      if (k < kMostFeatures)
        kept.push_back(moved[k].second);
      else
        left_out += (left_out.empty() ? "" : ", ") + label(problem_.observed, moved[k].second);
    }
    problem_.warnings.push_back(
        fmt::format("{} features are used; others tell less: {}", kMostFeatures, left_out));
    std::sort(kept.begin(), kept.end());
    const std::vector<Eigen::Index> rows(kept.begin(), kept.end());
    problem_.gap = part_of(problem_.gap, kept);
    problem_.signatures = part_of(problem_.signatures, kept);
    problem_.simulated = Eigen::VectorXd(problem_.simulated(rows));
    problem_.observed = subset(problem_.observed, kept);
    std::vector<NoiseBudget> noise;
    for (const std::size_t f : kept) noise.push_back(problem_.noise[f]);
    problem_.noise = std::move(noise);
  }

  const Experiment& experiment_;
  const BankPlan& plan_;
  const std::vector<SimulatedTests>& tests_;
  Problem problem_;
  bool scaled_ = false;
  std::vector<DesignRun> design_;
  std::vector<Eigen::VectorXd> baselines_;  // of specimens of the observed size
  std::vector<std::size_t> baseline_points_;
};

}  // namespace

Problem problem_of(const Experiment& experiment, const BankPlan& plan,
                   const std::vector<SimulatedTests>& tests) {
  return Learner(experiment, plan, tests).learn();
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
  for (auto& part : parts)
    for (auto& power : part.powers) power = Eigen::VectorXd(power(rows));
  return parts;
}

}  // namespace pendular::diagnosis
