#include "diagnosis/bank/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "diagnosis/bank/mean_row.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr int kReadLevels = 6, kReadMembers = 3;  // of effects that only change what instruments read
constexpr unsigned long kSeedOfHeld =
    100000;  // of the noise in fields of runs that are taken for experiments

/// The effect that is changed, and nothing else; nullptr: none, a pair, or a believed input.
const effects::Effect* only_effect_in(const Changes& changes) {
  return changes.size() == 1 ? effects::known_effect(changes.begin()->first) : nullptr;
}

void widen(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& block) {
  const Eigen::Index before = matrix.rows(), more = block.rows();
  matrix.conservativeResizeLike(Eigen::MatrixXd::Zero(before + more, before + more));
  matrix.bottomRightCorner(more, more) = block;
}

void widen(Eigen::VectorXd& vector, const Eigen::VectorXd& more) {
  vector.conservativeResize(vector.size() + more.size());
  vector.tail(more.size()) = more;
}

}  // namespace

/// A design, and how further runs are read for it.
struct BankFeatures::Learnt {
  Design design;
  std::vector<FieldReader> readers;  // of fields_
  std::vector<Eigen::Index> kept;    // of all features
};

BankFeatures::BankFeatures(Level level, const Experiment& experiment, const BankPlan& plan,
                           const std::vector<SimulatedTests>& tests)
    : observed_(observed_features(level, experiment)),
      points_(plan.points),
      scaled_(plan.scaled()),
      name_(experiment.name) {
  values_.resize(points_.size());
  for_blocks(points_.size(), 1, [&](std::size_t k, std::size_t) {
    values_[k] = simulated_features(experiment, plan.conditions, observed_, tests[k], points_[k].changes);
  });
  if (level == Level::readings)
    for (std::size_t index = 0; index < experiment.observations.size(); ++index) {
      const Observation& observation = experiment.observations[index];
      if (auto bank = field_bank(experiment, plan, index, tests))
        fields_.emplace_back(index, std::move(*bank));
      else if (observation.kind->field && !observation.beads.empty())
        unread_.push_back(observation.name);
    }
}

DesignRun BankFeatures::run_of(std::size_t k, Eigen::VectorXd values) const {
  const DesignPoint& point = points_[k];
  const effects::Effect* effect = only_effect_in(point.changes);
  // What pairs leave is no scatter of the members either.
  const bool draws = point.changes.size() > 1 || (effect && effect->draws);
  return {point.member,     point.id, point.theta, std::move(values), draws, effect && effect->reads_only(),
          effect != nullptr};
}

BankFeatures::Learnt BankFeatures::learn(std::vector<std::string>& warnings, int but) const {
  Learnt learnt;
  for (const auto& name : unread_)
    warnings.push_back(name +
                       ": its displacements are not used: too few beads are held by three bonds each, or no "
                       "simulation shows them");
  ObservedFeatures observed = observed_;
  std::vector<Eigen::VectorXd> values = values_;
  Eigen::VectorXd by_noise = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(observed.features.size()));
  for (const auto& [observation, bank] : fields_) {
    const FieldReader& reader = learnt.readers.emplace_back(bank, points_, but);
    const auto features = reader.measured(bank);
    const auto of_runs = reader.of_runs(bank, points_);
    std::vector<Eigen::VectorXd> baselines;
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (bank.of_runs[k] && points_[k].id.empty() && points_[k].member != but)
        baselines.push_back(of_runs[k]);
    const auto more = static_cast<Eigen::Index>(features.size());
    observed.features.insert(observed.features.end(), features.begin(), features.end());
    observed.observation.resize(observed.features.size(), observation);
    widen(observed.measurement, Eigen::MatrixXd::Zero(more, more));  // simulated fields have the noise
    widen(observed.model, field_model_error(baselines));
    widen(by_noise, reader.by_noise(bank, points_));
    for (std::size_t k = 0; k < points_.size(); ++k) widen(values[k], of_runs[k]);
  }

  std::vector<Eigen::VectorXd> whole;
  for (std::size_t k = 0; k < points_.size(); ++k)
    if (points_[k].whole && points_[k].id.empty() && points_[k].member != but) whole.push_back(values[k]);
  const Eigen::VectorXd mean = mean_row(whole, static_cast<Eigen::Index>(observed.features.size()));
  std::vector<std::size_t> kept;
  for (std::size_t f = 0; f < observed.features.size(); ++f) {
    const auto at = static_cast<Eigen::Index>(f);
    int shown = 0, asked = 0;
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (points_[k].whole != scaled_ && !points_[k].scans_only && !points_[k].at_fit &&
          points_[k].member != but)
        ++asked, shown += std::isfinite(values[k][at]);
    if (std::isfinite(mean[at]) && shown >= kThresholds.shown_by * asked)
      kept.push_back(f);
    else if (observed.level == Level::landmarks)
      warnings.push_back(fmt::format("{}: {} was observed but only {} of {} simulations show it; not used",
                                     observed.features[f].observation, observed.features[f].name, shown,
                                     asked));
  }
  if (kept.empty())
    bad_input(
        "{}: found no feature that observations and simulations share, expected e.g. a compression that "
        "shows its linear part",
        name_);
  learnt.kept.assign(kept.begin(), kept.end());
  learnt.design.observed = subset(observed, kept);
  learnt.design.by_noise = by_noise(learnt.kept);
  for (const auto& one : whole) learnt.design.whole.push_back(one(learnt.kept));
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (points_[k].whole == scaled_ || points_[k].member == but) continue;
    if (!points_[k].at_fit)
      learnt.design.runs.push_back(run_of(k, values[k](learnt.kept)));
    else if (but == 0)
      learnt.design.at_fit.push_back({run_of(k, values[k](learnt.kept)), points_[k].changes});
  }
  return learnt;
}

Design BankFeatures::design(std::vector<std::string>& warnings, int but) const {
  return learn(warnings, but).design;
}

std::pair<Design, std::vector<KnownRun>> BankFeatures::held_out(int member, int draws) const {
  std::vector<std::string> ignored;
  Learnt learnt = learn(ignored, member);
  std::vector<KnownRun> held;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (points_[k].member != member || points_[k].whole == scaled_ || points_[k].at_fit) continue;
    for (int draw = 0; draw < draws; ++draw) {
      Eigen::VectorXd values = values_[k];
      for (std::size_t f = 0; f < fields_.size(); ++f) {
        const auto& field = fields_[f].second.of_runs[k];
        if (!field) break;
        const FieldReader& reader = learnt.readers[f];
        widen(values,
              reader.read(*field + reader.noise(kSeedOfHeld + 100 * k + static_cast<unsigned long>(draw))));
      }
      if (values.size() <= learnt.kept.back()) break;
      values = Eigen::VectorXd(values(learnt.kept));
      if (!values.allFinite()) break;
      held.push_back({run_of(k, std::move(values)), points_[k].changes});
    }
  }
  return {std::move(learnt.design), std::move(held)};
}

std::vector<int> BankFeatures::members() const {
  std::set<int> found;
  for (const auto& point : points_)
    if (!point.scans_only) found.insert(point.member);
  return {found.begin(), found.end()};
}

std::pair<BankPlan, std::vector<SimulatedTests>> with_readings(const BankPlan& plan,
                                                               const std::vector<SimulatedTests>& tests) {
  std::pair<BankPlan, std::vector<SimulatedTests>> bank{plan, tests};
  for (const auto& effect : effects::all_effects()) {
    if (!effect.reads_only() || plan.absent.contains(effect.id)) continue;
    for (int level = 1; level <= kReadLevels; ++level) {
      const double theta = kThresholds.beyond_bank * effect.bank_to * level / kReadLevels;
      for (std::size_t k = 0; k < plan.points.size(); ++k) {
        DesignPoint point = plan.points[k];
        if (!point.id.empty() || point.whole == plan.scaled() || point.member > kReadMembers) continue;
        point.id = effect.id, point.theta = theta, point.changes = {{effect.id, theta}};
        SimulatedTests all_read;
        for (const auto& test : tests[k]) {
          auto read = test ? std::make_shared<SimulatedTest>(*test) : nullptr;
          if (read) read_test(effect, theta, *read);
          all_read.push_back(std::move(read));
        }
        bank.first.points.push_back(point);
        bank.second.push_back(std::move(all_read));
      }
    }
  }
  return bank;
}

}  // namespace pendular::diagnosis
