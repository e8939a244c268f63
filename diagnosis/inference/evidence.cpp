#include "diagnosis/inference/evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "diagnosis/inference/at_fit.h"
#include "diagnosis/inference/log_sum.h"
#include "diagnosis/inference/magnitude_grid.h"
#include "diagnosis/inference/weigher.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr int kCells = 81;            // of an effect's range, in which another's nearest is looked for
constexpr double kNegligible = 12.0;  // evidence of a pair, as a logarithm, below the best one's
constexpr double kLeading = 1.0;      // the same above it, from which a pair may displace a single effect
constexpr double kLeastShare = 0.01, kStep = 1.25;  // of the magnitudes at which an effect is looked for

Weighed none(const ReducedSpace& space, const AtFit* at_fit, const ReducedGap& gap, bool beside) {
  const Eigen::Index size = space.size();
  std::vector<Expected> nothing = {{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)}};
  if (at_fit) nothing.front().add(*at_fit);
  Workspace room(size);
  const Predictions said = space.predict(nothing, 1.0, room);
  const Fits fits = space.fit(gap, responses_of(nothing), said, room);
  const double chi_squared = fits.chi_squared[0];
  return {{"none", fits.log_likelihood[0], 0.0, {}, chi_squared},
          beside ? beside_unknown(space, gap, said, 0, chi_squared) : 0.0};
}

/// Logarithm of the mean evidence of what is alike before any data.
double mean_of(const std::vector<double>& logs) {
  return log_sum(logs) - std::log(static_cast<double>(logs.size()));
}

/// Something beside what is known, or, by chance, something that does what a known effect would.
Hypothesis unknown(const std::vector<Weighed>& known, const Priors& priors) {
  const Hypothesis& none = known.front().hypothesis;
  if (priors.unknown <= 0.0) return {"unknown", none.log_evidence, 0.0, {}, none.chi_squared};
  std::vector<double> beside, like;
  for (const auto& one : known) {
    beside.push_back(one.beside_unknown);
    if (one.hypothesis.magnitudes.size() == 1) like.push_back(one.hypothesis.log_evidence);
  }
  const double other = mean_of(beside);
  Hypothesis found{"unknown", other, 0.0, {}, none.chi_squared};
  if (!like.empty())
    found.log_evidence = log_sum(
        std::array{other + std::log(1.0 - priors.like_known), mean_of(like) + std::log(priors.like_known)});
  return found;
}

/// Evidences times priors, made to sum to one; most probable first.
void make_probabilities(std::vector<Hypothesis>& hypotheses,
                        const std::function<double(const Hypothesis&)>& prior) {
  std::vector<double> log_weight;
  for (auto& h : hypotheses) {
    h.log_prior = std::log(prior(h));
    log_weight.push_back(h.log_prior + h.log_evidence);
  }
  const double total = log_sum(log_weight);
  for (std::size_t k = 0; k < hypotheses.size(); ++k)
    hypotheses[k].probability = std::exp(log_weight[k] - total);
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

/// What two effects do together, reduced, in their order; none where they were not run.
std::optional<Together> together_of(const std::vector<Together>& all, const Signature& a, const Signature& b,
                                    const ReducedSpace& space) {
  for (Together one : all) {
    if (one.a == b.id && one.b == a.id) std::swap(one.a, one.b), std::swap(one.theta_a, one.theta_b);
    if (one.a != a.id || one.b != b.id) continue;
    one.beyond = space.reduced(one.beyond);
    if (one.error.size() > 0) one.error = space.reduced_covariance(one.error);
    return one;
  }
  return std::nullopt;
}

const Hypothesis& best_of(const std::vector<Hypothesis>& all) {
  return *std::max_element(all.begin(), all.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.log_evidence < b.log_evidence;
  });
}

/// A reduced signature whose least magnitude is no larger than what these observations show of it.
Signature with_visible(Signature reduced) {
  for (const double end : {reduced.lowest, reduced.highest})
    for (double theta = kLeastShare * end; std::fabs(theta) < reduced.least; theta *= kStep)
      if (theta == 0.0 || reduced.at(theta).norm() > kThresholds.visible) {
        if (theta != 0.0) reduced.least = std::fabs(theta);
        break;
      }
  return reduced;
}

/// What an effect does at its usual magnitude, of either sign where it has two: the larger one.
Eigen::VectorXd at_scale(const Signature& signature) {
  Eigen::VectorXd above = signature.at(signature.scale), below = signature.at(-signature.scale);
  if (signature.highest <= 0.0) return below;
  return signature.lowest < 0.0 && below.norm() > above.norm() ? std::move(below) : std::move(above);
}

}  // namespace

Weigher::Weigher(const Gap& gap, const std::vector<Signature>& signatures,
                 const std::vector<Together>& together, const Priors& priors, Pairs which)
    : space_(gap, signatures), priors_(priors), which_(which) {
  reduced_.reserve(signatures.size());
  for (const auto& signature : signatures) reduced_.push_back(with_visible(space_.reduced(signature)));
  for (std::size_t a = 0; a < reduced_.size(); ++a)
    for (std::size_t b = a + 1; b < reduced_.size(); ++b) {
      auto run = together_of(together, reduced_[a], reduced_[b], space_);
      pairs_.push_back({a, b, std::move(run)});
    }
  for (AtFit one : gap.at_fit) {
    one.beyond = space_.reduced(one.beyond), one.error = space_.reduced_covariance(one.error);
    at_fit_.push_back(std::move(one));
  }
}

bool Weigher::absent(const std::string& effect, double theta) const {
  return std::any_of(reduced_.begin(), reduced_.end(),
                     [&](const Signature& one) { return one.id == effect && std::fabs(theta) < one.least; });
}

// What an effect or a pair says is worked out once, for all observations.
std::vector<std::vector<Hypothesis>> Weigher::of_singles(const std::vector<ReducedGap>& gaps,
                                                         double negligible) const {
  std::vector<std::optional<MagnitudeGrid>> grids(reduced_.size());
  std::vector<std::vector<std::vector<MagnitudeGrid::Fitted>>> fitted(reduced_.size());
  for_blocks(reduced_.size(), 1, [&](std::size_t e, std::size_t) {
    grids[e].emplace(std::vector{reduced_[e]}, std::nullopt, at_fit_near({reduced_[e].id, "none"}), space_);
    fitted[e] = grids[e]->fit(gaps);
  });
  const bool beside = priors_.unknown > 0.0;
  std::vector<std::vector<Hypothesis>> all(gaps.size());
  for_blocks(gaps.size(), 1, [&](std::size_t k, std::size_t) {
    std::vector<Weighed> known = {none(space_, at_fit_of(at_fit_, "none"), gaps[k], beside)};
    double best = known.front().hypothesis.log_evidence;
    for (const auto& of_effect : fitted) best = std::max(best, MagnitudeGrid::evidence_of(of_effect[k]));
    for (std::size_t e = 0; e < grids.size(); ++e)
      known.push_back(grids[e]->weigh(gaps[k], std::move(fitted[e][k]), best - negligible, beside));
    all[k].push_back(unknown(known, priors_));
    for (auto& one : known) all[k].push_back(std::move(one.hypothesis));
  });
  return all;
}

const AtFit* Weigher::at_fit_near(const std::vector<std::string>& ids) const {
  for (const auto& id : ids)
    if (const AtFit* found = at_fit_of(at_fit_, id)) return found;
  return nullptr;
}

const AtFit* Weigher::at_fit_near(const Pair& pair, const std::vector<Hypothesis>& singles) const {
  if (at_fit_.empty()) return nullptr;
  const auto evidence_of = [&](const std::string& id) {
    return std::find_if(singles.begin(), singles.end(), [&](const Hypothesis& h) { return h.id == id; })
        ->log_evidence;
  };
  const std::string &a = reduced_[pair.a].id, &b = reduced_[pair.b].id;
  return at_fit_near({a + "+" + b, evidence_of(a) < evidence_of(b) ? b : a, "none"});
}

bool Weigher::matters(const Pair& pair, const std::vector<Hypothesis>& singles) const {
  if (pair.run || which_ != Pairs::leading) return true;
  const Hypothesis* best = nullptr;
  for (const auto& h : singles)
    if (h.magnitudes.size() == 1 && (!best || h.log_evidence > best->log_evidence)) best = &h;
  return best && (reduced_[pair.a].id == best->id || reduced_[pair.b].id == best->id);
}

void Weigher::add_pairs(const std::vector<ReducedGap>& gaps, double negligible,
                        std::vector<std::vector<Hypothesis>>& all) const {
  std::vector<std::vector<std::optional<Hypothesis>>> of_pairs(pairs_.size());
  for_blocks(pairs_.size(), 1, [&](std::size_t p, std::size_t) {
    const auto& [a, b, run] = pairs_[p];
    std::vector<std::size_t> places;
    std::vector<ReducedGap> theirs;
    for (std::size_t k = 0; k < gaps.size(); ++k)
      if (matters(pairs_[p], all[k])) places.push_back(k), theirs.push_back(gaps[k]);
    of_pairs[p].resize(gaps.size());
    if (places.empty()) return;
    MagnitudeGrid grid({reduced_[a], reduced_[b]}, run, at_fit_near(pairs_[p], all[places.front()]), space_);
    auto fitted = grid.fit(theirs);
    const double less = run                        ? negligible
                        : which_ == Pairs::leading ? -kLeading
                                                   : std::min(negligible, kNegligible);
    for (std::size_t n = 0; n < places.size(); ++n) {
      auto& found = of_pairs[p][places[n]];
      const double least = best_of(all[places[n]]).log_evidence - less;
      found = grid.weigh(theirs[n], std::move(fitted[n]), least, false).hypothesis;
      found->run = run.has_value();
    }
  });
  for (std::size_t k = 0; k < gaps.size(); ++k)
    for (auto& of_pair : of_pairs)
      if (of_pair[k]) all[k].push_back(std::move(*of_pair[k]));
}

std::vector<std::vector<Hypothesis>> Weigher::operator()(const std::vector<Eigen::VectorXd>& observed,
                                                         double negligible) const {
  std::vector<ReducedGap> gaps;
  for (const auto& values : observed) gaps.push_back(space_.gap(values));
  auto all = of_singles(gaps, negligible);
  add_pairs(gaps, negligible, all);
  const double effects = static_cast<double>(reduced_.size());
  const double pairs = effects > 1.0 ? priors_.pairs : 0.0;
  for (auto& hypotheses : all)
    make_probabilities(hypotheses, [&](const Hypothesis& h) {
      if (h.id == "none") return priors_.none;
      if (h.id == "unknown") return priors_.unknown;
      if (h.magnitudes.size() == 2) return pairs / (0.5 * effects * (effects - 1.0));
      return (1.0 - priors_.none - priors_.unknown - pairs) / effects;
    });
  return all;
}

std::vector<std::string> effects_in(const std::string& id) {
  if (id == "none" || id == "unknown" || id == kOtherPairs) return {};
  const auto plus = id.find('+');
  if (plus == std::string::npos) return {id};
  return {id.substr(0, plus), id.substr(plus + 1)};
}

std::vector<Hypothesis> weigh(const Gap& gap, const std::vector<Signature>& signatures,
                              const std::vector<Together>& together, const Priors& priors, Pairs which) {
  return Weigher(gap, signatures, together, priors, which)({gap.values}).front();
}

Eigen::MatrixXd isolability(const Gap& gap, const std::vector<Signature>& signatures) {
  const ReducedSpace space(gap, signatures);
  const auto size = static_cast<Eigen::Index>(signatures.size());
  Eigen::MatrixXd distance = Eigen::MatrixXd::Zero(size, size + 1);
  std::vector<Signature> reduced;
  for (const auto& signature : signatures) reduced.push_back(space.reduced(signature));
  for (Eigen::Index a = 0; a < size; ++a) {
    const Eigen::VectorXd here = at_scale(reduced[static_cast<std::size_t>(a)]);
    distance(a, size) = here.squaredNorm();
    for (Eigen::Index b = 0; b < size; ++b) {
      if (a == b) continue;
      distance(a, b) = distance(a, size);
      const Signature& other = reduced[static_cast<std::size_t>(b)];
      for (int k = 0; k < kCells; ++k) {
        const double theta = other.lowest + (other.highest - other.lowest) * (k + 0.5) / kCells;
        distance(a, b) = std::min(distance(a, b), (here - other.at(theta)).squaredNorm());
      }
    }
  }
  return distance;
}

}  // namespace pendular::diagnosis
