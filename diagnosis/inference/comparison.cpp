#include "diagnosis/inference/comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/eigensystem.h"
#include "base/quantile.h"
#include "base/random.h"
#include "diagnosis/bank/contact_features.h"
#include "diagnosis/bank/law_readings.h"
#include "diagnosis/bank/mean_row.h"
#include "diagnosis/bank/model_error.h"
#include "diagnosis/inference/at_fit.h"
#include "diagnosis/inference/reduced_space.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr std::size_t kLeastAtFit = 3;  // runs at a fit that say what it is off by

double largest_in_bank(const effects::Effect& effect) {
  return std::max(std::fabs(effect.bank_from), std::fabs(effect.bank_to));
}

/// Builds a comparison from a design.
class Learner {
 public:
  Learner(const Experiment& experiment, const BankPlan& plan, const Design& design)
      : experiment_(experiment), plan_(plan), design_(design) {
    found_.observed = design.observed;
  }

  Comparison learn() {
    fit();
    return std::move(found_);
  }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(found_.observed.features.size()); }

  void fit() {
    const Responses responses = fit_responses(design_.runs, size());
    found_.simulated = mean_row(design_.whole, size());
    found_.gap.values = found_.observed.values() - found_.simulated;
    set_signatures(responses);
    set_together(responses);
    set_laws(responses);
    set_believed(responses);
    set_covariance(responses);
    if (found_.observed.level != Level::readings) return;
    set_outside(responses);
    set_at_fit(responses);
  }

  void set_signatures(const Responses& responses) {
    for (const auto& effect : effects::all_effects()) {
      if (plan_.absent.contains(effect.id)) continue;
      const Signature* learnt = responses.find(effect.id);
      if (!learnt) continue;
      Signature signature = *learnt;
      signature.lowest = std::max(effect.lowest, kThresholds.beyond_bank * effect.bank_from);
      signature.highest = std::min(effect.highest, kThresholds.beyond_bank * effect.bank_to);
      signature.scale = usual_magnitude(effect),
      signature.least = kThresholds.least_share * largest_in_bank(effect);
      signature.error = effect.beads ? kThresholds.error_of_beads : kThresholds.response_error;
      if (effect.reads_only() && !effect.lengths) add_true_strains(signature);
      found_.signatures.push_back(std::move(signature));
    }
  }

  /// Strains of scans, or of gauges as well, may be those of the specimen: a wrong reading of the machine
  /// does nothing there.
  void add_true_strains(Signature& signature) const {
    Response response = signature;
    for (const StrainBy measured : {StrainBy::scan, StrainBy::gauge}) {
      bool differs = false;
      for (std::size_t f = 0; f < found_.observed.features.size(); ++f) {
        const std::size_t o = found_.observed.observation[f];
        if (o >= experiment_.observations.size() || experiment_.observations[o].kind->strain_by != measured)
          continue;
        for (auto& power : response.powers) {
          double& of_feature = power[static_cast<Eigen::Index>(f)];
          differs = differs || of_feature != 0.0;
          of_feature = 0.0;
        }
      }
      if (differs) signature.others.push_back(response);
    }
  }

  /// Of the pairs that were run: what they do beyond the sum of their responses.
  void set_together(const Responses& responses) {
    for (const auto& point : plan_.points) {
      const Signature* both = responses.find(point.id);
      const bool known = std::any_of(found_.together.begin(), found_.together.end(),
                                     [&](const Together& t) { return t.a + "+" + t.b == point.id; });
      if (point.at_fit || point.changes.size() != 2 || !both || known) continue;
      Together pair{point.changes.begin()->first, point.changes.rbegin()->first,
                    point.changes.begin()->second, point.changes.rbegin()->second, both->at(1.0)};
      for (const auto& signature : found_.signatures) {
        if (signature.id == pair.a) pair.beyond -= signature.at(pair.theta_a);
        if (signature.id == pair.b) pair.beyond -= signature.at(pair.theta_b);
      }
      const auto runs = std::count_if(design_.runs.begin(), design_.runs.end(),
                                      [&](const DesignRun& run) { return run.id == point.id; });
      pair.error = responses.within / static_cast<double>(runs);
      if (both->draws.size() > 0) pair.error += both->grown(1.0) / static_cast<double>(runs) * both->draws;
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
    for (const auto& law : found_.laws) {
      const LawReading& reading = *find_law_reading(law.id);
      add(reading.name, share_of_law(plan_, reading) * law.mean);
    }
    Eigen::VectorXd stresses(size());
    for (Eigen::Index f = 0; f < size(); ++f)
      stresses[f] = shared_stress_error(found_.observed.features[static_cast<std::size_t>(f)]);
    add(kSimulationError, stresses);
    const bool measured = std::any_of(plan_.conditions.begin(), plan_.conditions.end(),
                                      [](const Condition& c) { return !c.beads.empty(); });
    // The specimen is to the measured one as that is to those with further errors.
    if (measured && responses.offsets.rows() > 1)
      add(kBeadsError, responses.mean - responses.offsets.row(0).transpose());
    if (design_.by_noise.squaredNorm() > 0.0) add(kFieldError, design_.by_noise);
    found_.gap.believed = Eigen::MatrixXd(size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      found_.gap.believed.col(static_cast<Eigen::Index>(c)) = columns[c];
  }

  /// What the other reading does to members differs: noise beside the mean, which is believed.
  void set_laws(const Responses& responses) {
    for (const auto& reading : law_readings()) {
      const Signature* found = responses.find(reading.id);
      if (!found) continue;
      found_.laws.push_back({reading.id,
                             found->at(1.0).unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }),
                             found->draws});
      found_.observed.model += std::pow(share_of_law(plan_, reading), 2) * found->draws;
    }
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
    if (observed.level == Level::readings) found_.gap.covariance.diagonal() *= 1.0 + kThresholds.uncorrelated;
    for (Eigen::Index f = 0; f < size(); ++f)
      if (is_of_beads(observed.features[static_cast<std::size_t>(f)])) found_.gap.exact.push_back(f);
    // Welch and Satterthwaite: only the ensemble's part of the noise was estimated.
    found_.gap.dof = scatter.dof / std::max(1e-6, share * share);
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
        drawn[k] = random_normal(static_cast<std::uint64_t>(&run - design_.runs.data()),
                                 static_cast<std::uint64_t>(k));
      return space.outside(run.values - responses.mean + noise * drawn);
    };
    for (const auto& run : design_.runs)
      if (run.values.allFinite() && !signature_of(run.id) && run.id.find('+') == std::string::npos)
        found_.gap.outside.push_back(outside(run));
    if (found_.gap.outside.empty()) return;
    const double usual = median(found_.gap.outside);
    for (auto& signature : found_.signatures) {
      std::vector<double> shares;
      for (const auto& run : design_.runs)
        if (run.id == signature.id && run.values.allFinite())
          shares.push_back(std::max(0.0, outside(run) - usual) /
                           (1.0 + space.reduced(run.values - responses.mean).squaredNorm()));
      if (!shares.empty()) signature.outside = std::max(signature.outside, std::sqrt(mean_of(shares)));
    }
  }

  /// What responses to some changes add up to.
  Eigen::VectorXd added_up(const Changes& changes, const Responses& responses) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(size());
    for (const auto& [key, value] : changes) {
      const Signature* effect = signature_of(key);
      if (const Signature* response = effect ? effect : responses.find(key))
        sum += response->at(value).unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
    }
    for (const auto& pair : found_.together)
      if (changes.contains(pair.a) && changes.contains(pair.b))
        sum += pair.at(changes.at(pair.a), changes.at(pair.b));
    return sum;
  }

  void set_at_fit(const Responses& responses) {
    std::map<std::string, std::vector<const KnownRun*>> explanations;
    for (const auto& one : design_.at_fit)
      if (one.run.values.allFinite()) explanations[one.run.id].push_back(&one);
    if (explanations.empty()) return;
    const ReducedSpace space(found_.gap, found_.signatures);
    for (const auto& [id, runs] : explanations) {
      if (runs.size() < kLeastAtFit) continue;
      const Changes& changes = runs.front()->truth;
      const Eigen::VectorXd expected = added_up(changes, responses);
      Eigen::MatrixXd rows(static_cast<Eigen::Index>(runs.size()), size());
      for (std::size_t r = 0; r < runs.size(); ++r)
        rows.row(static_cast<Eigen::Index>(r)) =
            (runs[r]->run.values - responses.baseline(runs[r]->run.member) - expected).transpose();
      Eigen::MatrixXd drawn = Eigen::MatrixXd::Zero(space.size(), space.size());
      for (const auto& [key, value] : changes)
        if (const Signature* effect = signature_of(key)) {
          const Response response = space.reduced(*effect).response(value);
          if (response.draws.size() > 0) drawn += response.grown(value) * response.draws;
        }
      found_.gap.at_fit.push_back(at_fit(id, rows, drawn, space));
    }
  }

  const Signature* signature_of(const std::string& id) const {
    for (const auto& signature : found_.signatures)
      if (signature.id == id) return &signature;
    return nullptr;
  }

  const Experiment& experiment_;
  const BankPlan& plan_;
  const Design& design_;
  Comparison found_;
};

}  // namespace

double usual_magnitude(const effects::Effect& effect) {
  return kThresholds.usual_share * largest_in_bank(effect);
}

double share_of_law(const BankPlan& plan, const LawReading& law) {
  return plan.as_stated.contains(law.id) ? kThresholds.law_as_stated : kThresholds.law_reading;
}

Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  const auto [values, vectors] = eigensystem(covariance);
  return vectors * values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

Eigen::VectorXd left_by(const Comparison& comparison, const Magnitudes& magnitudes) {
  Eigen::VectorXd left = comparison.gap.values;
  for (const auto& signature : comparison.signatures)
    if (const auto found = magnitudes.find(signature.id); found != magnitudes.end())
      left -= signature.response(found->second.mean, found->second.reading).at(found->second.mean);
  for (const auto& pair : comparison.together)
    if (magnitudes.contains(pair.a) && magnitudes.contains(pair.b))
      left -= pair.at(magnitudes.at(pair.a).mean, magnitudes.at(pair.b).mean);
  for (const auto& run : comparison.gap.at_fit) {
    const auto ids = effects_in(run.id);
    if (ids.size() == magnitudes.size() &&
        std::all_of(ids.begin(), ids.end(), [&](const std::string& id) { return magnitudes.contains(id); }))
      left -= run.beyond;
  }
  return left;
}

Eigen::VectorXd pulls_of(const Gap& gap, const Eigen::VectorXd& left) {
  return gap.believed.transpose() * whole_covariance(gap).llt().solve(left);
}

Comparison compare(const Experiment& experiment, const BankPlan& plan, const Design& design) {
  return Learner(experiment, plan, design).learn();
}

Gap part_of(const Gap& gap, const std::vector<std::size_t>& features) {
  const std::vector<Eigen::Index> rows(features.begin(), features.end());
  Gap part;
  part.values = gap.values(rows);
  part.covariance = gap.covariance(rows, rows);
  part.believed = gap.believed(rows, Eigen::all);
  part.dof = gap.dof;
  return part;
}

std::vector<Signature> part_of(const std::vector<Signature>& signatures,
                               const std::vector<std::size_t>& features) {
  const std::vector<Eigen::Index> rows(features.begin(), features.end());
  std::vector<Signature> parts = signatures;
  const auto take = [&](Response& response) {
    for (auto& power : response.powers) power = Eigen::VectorXd(power(rows));
    if (response.early.size() > 0) response.early = Eigen::VectorXd(response.early(rows));
    if (response.draws.size() > 0) response.draws = Eigen::MatrixXd(response.draws(rows, rows));
    if (response.missed.size() > 0) response.missed = Eigen::MatrixXd(response.missed(Eigen::all, rows));
    if (response.scatter.size() > 0) response.scatter = Eigen::MatrixXd(response.scatter(rows, rows));
  };
  for (auto& part : parts) {
    take(part);
    if (part.below) take(*part.below);
    for (auto& other : part.others) take(other);
  }
  return parts;
}

std::vector<Together> part_of(const std::vector<Together>& together,
                              const std::vector<std::size_t>& features) {
  const std::vector<Eigen::Index> rows(features.begin(), features.end());
  std::vector<Together> parts = together;
  for (auto& part : parts) {
    part.beyond = Eigen::VectorXd(part.beyond(rows));
    if (part.error.size() > 0) part.error = Eigen::MatrixXd(part.error(rows, rows));
  }
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
