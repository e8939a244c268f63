#include "diagnosis/inference/magnitude_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>

#include "diagnosis/inference/log_sum.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

// Of a response's own covariance, in terms of standard deviations.
constexpr double kScale[] = {0.4, 0.63, 1.0, 1.6, 2.5};
const double kLogScaleWeights[] = {std::log(0.1), std::log(0.24), std::log(0.32), std::log(0.24),
                                   std::log(0.1)};
constexpr int kCellsOfOne = 41, kCellsOfTwo = 11;  // of each effect's range
constexpr int kRefined = 3, kParts = 4;            // how often cells at the peak are cut, and into how many
constexpr double kUnknownFactors[] = {1.0, 1.5, 2.5, 4.0, 7.0};  // of the noise's standard deviation
constexpr double kNoWeight = 1e-14;                              // of a cell, over that of all
constexpr double kNever = -std::numeric_limits<double>::infinity();

/// All magnitudes are alike a priori, those below the least one aside.
double log_prior_of(const Signature& signature, double theta, double width) {
  if (std::fabs(theta) < signature.least) return kNever;
  const double absent = std::max(
      0.0, std::min(signature.highest, signature.least) - std::max(signature.lowest, -signature.least));
  return std::log(width / (signature.highest - signature.lowest - absent));
}

/// How a reduced response is known by any run: to a share of itself in the directions that are not exact.
Eigen::VectorXd variance_of(const Signature& reduced, const Eigen::VectorXd& response, Eigen::Index inexact) {
  const auto free = response.head(inexact);
  const double everywhere =
      kThresholds.everywhere * free.squaredNorm() / std::max<double>(1.0, static_cast<double>(inexact));
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(response.size());
  variance.head(inexact) = reduced.error * reduced.error * (free.array().square() + everywhere);
  return variance;
}

}  // namespace

// The likelihood is a product of both parts, so the sum over pairs of factors is one of products of sums.
double beside_unknown(const ReducedSpace& space, const ReducedGap& gap, const Predictions& predictions,
                      std::size_t lane, double chi_squared) {
  std::vector<double> within, outside;
  for (const double factor : kUnknownFactors) {
    within.push_back(space.log_within(predictions, lane, chi_squared, factor));
    outside.push_back(space.log_outside(predictions, lane, gap, factor));
  }
  const double usual_outside = outside.front();
  const std::vector<double> wider_within(within.begin() + 1, within.end()),
      wider_outside(outside.begin() + 1, outside.end());
  return log_sum(
             std::array{log_sum(within) + log_sum(wider_outside), log_sum(wider_within) + usual_outside}) -
         std::log(static_cast<double>(within.size() * outside.size() - 1));
}

double MagnitudeGrid::Fitted::log_density(std::size_t effects) const {
  double density = log_weight();
  for (std::size_t e = 0; e < effects; ++e) density -= std::log(place().cells[e].width);
  return density;
}

MagnitudeGrid::MagnitudeGrid(std::vector<Signature> reduced, std::optional<Together> together,
                             const AtFit* at_fit, const ReducedSpace& space)
    : reduced_(std::move(reduced)), together_(std::move(together)), at_fit_(at_fit), space_(space) {}

std::vector<std::vector<MagnitudeGrid::Fitted>> MagnitudeGrid::fit(std::span<const ReducedGap> gaps) {
  std::vector<Cells> all;
  for (const Cells& whole : whole_ranges()) {
    const auto parts = parts_of(whole, reduced_.size() > 1 ? kCellsOfTwo : kCellsOfOne);
    all.insert(all.end(), parts.begin(), parts.end());
  }
  std::vector<std::vector<Fitted>> fitted(gaps.size());
  fit(all, gaps, batches_, fitted);
  return fitted;
}

/// The range of each effect, for all readings of these.
std::vector<MagnitudeGrid::Cells> MagnitudeGrid::whole_ranges() const {
  std::vector<Cells> found = {{}};
  for (std::size_t e = 0; e < reduced_.size(); ++e) {
    const Signature& one = reduced_[e];
    std::vector<Cells> longer;
    for (const Cells& so_far : found)
      for (std::size_t reading = 0; reading < one.readings(); ++reading)
        (longer.emplace_back(so_far))[e] = {0.5 * (one.lowest + one.highest), one.highest - one.lowest,
                                            reading};
    found = std::move(longer);
  }
  return found;
}

/// The cell of each effect, cut into so many.
std::vector<MagnitudeGrid::Cells> MagnitudeGrid::parts_of(const Cells& cells, int parts) const {
  std::vector<Cells> found = {cells};
  for (std::size_t e = 0; e < reduced_.size(); ++e) {
    std::vector<Cells> longer;
    for (const auto& so_far : found)
      for (int k = 0; k < parts; ++k)
        (longer.emplace_back(so_far))[e] = {cells[e].theta + cells[e].width * ((k + 0.5) / parts - 0.5),
                                            cells[e].width / parts, cells[e].reading};
    found = std::move(longer);
  }
  return found;
}

// Covariances stay in fast memory: those of some places at one scale are factored, and serve for all gaps.
void MagnitudeGrid::fit(const std::vector<Cells>& all, std::span<const ReducedGap> gaps, Batches& batches,
                        std::span<std::vector<Fitted>> to) const {
  static_assert(std::size(kScale) == kScales && std::size(kLogScaleWeights) == kScales);
  std::vector<Place> places;
  for (const auto& cells : all) {
    double log_prior = 0.0;
    for (std::size_t e = 0; e < reduced_.size(); ++e)
      log_prior += log_prior_of(reduced_[e], cells[e].theta, cells[e].width) -
                   std::log(static_cast<double>(reduced_[e].readings()));
    if (log_prior != kNever) places.push_back({cells, log_prior});
  }
  // Cells of two effects are all pairs of some of each.
  std::array<std::map<std::pair<std::size_t, double>, Expected>, 2> known;
  const auto of_effect = [&](std::size_t e, const Cell& cell) -> const Expected& {
    const auto [at, added] = known[e].try_emplace({cell.reading, cell.theta});
    if (added) at->second = expected_of(e, cell);
    return at->second;
  };
  Workspace room(space_.size());
  std::vector<std::array<Fits, kScales>> fits(gaps.size());
  for (std::size_t first = 0; first < places.size(); first += kLanes) {
    Batch& batch = batches.emplace_back();
    std::vector<Expected> here;
    for (std::size_t k = first; k < std::min(first + kLanes, places.size()); ++k) {
      const Cells& cells = places[k].cells;
      here.push_back(of_effect(0, cells[0]));
      if (reduced_.size() > 1) here.back() = together(here.back(), of_effect(1, cells[1]), cells);
      if (at_fit_) here.back().add(*at_fit_);
      batch.places.push_back(places[k]);
    }
    const auto responses = responses_of(here);
    for (std::size_t s = 0; s < kScales; ++s) {
      const Predictions& said = batch.predictions.emplace_back(space_.predict(here, kScale[s], room));
      for (std::size_t g = 0; g < gaps.size(); ++g) fits[g][s] = space_.fit(gaps[g], responses, said, room);
    }
    for (std::size_t g = 0; g < gaps.size(); ++g)
      for (std::size_t lane = 0; lane < here.size(); ++lane) to[g].push_back(fitted_of(batch, lane, fits[g]));
  }
}

/// Over all scales.
MagnitudeGrid::Fitted MagnitudeGrid::fitted_of(const Batch& batch, std::size_t lane,
                                               const std::array<Fits, kScales>& fits) {
  Fitted fitted{&batch, lane};
  std::array<double, kScales> terms;
  for (std::size_t s = 0; s < kScales; ++s) {
    fitted.chi_squareds[s] = fits[s].chi_squared[lane];
    terms[s] = kLogScaleWeights[s] + fits[s].log_likelihood[lane];
  }
  fitted.log_likelihood = log_sum(terms);
  return fitted;
}

/// What an effect does, and how it is known.
Expected MagnitudeGrid::expected_of(std::size_t effect, const Cell& cell) const {
  const double theta = cell.theta;
  const Signature& signature = reduced_[effect];
  const Response& response = signature.response(theta, cell.reading);
  Expected found{response.at(theta), {}};
  found.shares = variance_of(signature, found.response, space_.inexact());
  found.outside = std::pow(signature.outside, 2) * found.response.squaredNorm();
  if (response.draws.size() == 0) return found;
  const double grown = response.grown(theta);
  found.draws = {{&response.draws, grown}};
  found.drawn_outside = grown * response.drawn_outside;
  found.dof = response.drawn_dof;
  return found;
}

/// The same of two together.
Expected MagnitudeGrid::together(const Expected& a, const Expected& b, const Cells& cells) const {
  const double known = together_ ? kThresholds.run_together : kThresholds.together;
  Expected found{a.response + b.response,
                 a.shares + b.shares + known * known * a.response.cwiseProduct(b.response).cwiseAbs()};
  found.draws = a.draws;
  found.draws.insert(found.draws.end(), b.draws.begin(), b.draws.end());
  found.dof = a.dof > 0.0 && b.dof > 0.0 ? std::min(a.dof, b.dof) : std::max(a.dof, b.dof);
  found.outside = a.outside + b.outside, found.drawn_outside = a.drawn_outside + b.drawn_outside;
  if (!together_) return found;
  const double grown = together_->grown(cells[0].theta, cells[1].theta);
  found.response += grown * together_->beyond;
  if (together_->error.size() > 0) found.draws.emplace_back(&together_->error, grown * grown);
  return found;
}

double MagnitudeGrid::evidence_of(const std::vector<Fitted>& fitted) {
  std::vector<double> weights = {kNever};
  for (const auto& one : fitted) weights.push_back(one.log_weight());
  return log_sum(weights);
}

Weighed MagnitudeGrid::weigh(const ReducedGap& gap, std::vector<Fitted> fitted, double least,
                             bool beside) const {
  Batches finer;
  const int rounds = evidence_of(fitted) >= least ? kRefined : 0;
  for (int round = 0; round < rounds && !fitted.empty(); ++round) {
    const auto best = std::max_element(fitted.begin(), fitted.end(),
                                       [n = reduced_.size()](const Fitted& a, const Fitted& b) {
                                         return a.log_density(n) < b.log_density(n);
                                       })
                          ->place()
                          .cells;
    std::vector<Cells> cut;
    std::erase_if(fitted, [&](const Fitted& one) {
      const auto& cells = one.place().cells;
      for (std::size_t e = 0; e < reduced_.size(); ++e)
        if (cells[e].reading != best[e].reading ||
            std::fabs(cells[e].theta - best[e].theta) > 0.75 * (cells[e].width + best[e].width))
          return false;
      const auto parts = parts_of(cells, kParts);
      cut.insert(cut.end(), parts.begin(), parts.end());
      return true;
    });
    fit(cut, {&gap, 1}, finer, {&fitted, 1});
  }

  Weighed found;
  Hypothesis& hypothesis = found.hypothesis;
  hypothesis.chi_squared = std::numeric_limits<double>::infinity();
  std::vector<double> wider = {kNever};
  for (const auto& one : fitted) {
    if (beside)
      for (std::size_t k = 0; k < kScales; ++k)
        wider.push_back(
            one.place().log_prior + kLogScaleWeights[k] +
            beside_unknown(space_, gap, one.batch->predictions[k], one.lane, one.chi_squareds[k]));
    hypothesis.chi_squared = std::min(hypothesis.chi_squared, one.chi_squareds[kScales / 2]);
  }
  hypothesis.log_evidence = evidence_of(fitted), found.beside_unknown = log_sum(wider);
  for (std::size_t e = 0; e < reduced_.size(); ++e) {
    hypothesis.id += (e > 0 ? "+" : "") + reduced_[e].id;
    hypothesis.magnitudes.push_back(magnitude(e, fitted, hypothesis.log_evidence));
  }
  return found;
}

/// Mean and interval of one effect's magnitude a posteriori: each cell's weight is spread over its width.
Magnitude MagnitudeGrid::magnitude(std::size_t effect, const std::vector<Fitted>& fitted,
                                   double log_evidence) const {
  std::vector<std::pair<Cell, double>> cells;
  std::vector<double> of_reading(reduced_[effect].readings(), 0.0);
  Magnitude found;
  for (const auto& one : fitted) {
    const double weight = std::exp(one.log_weight() - log_evidence);
    if (weight < kNoWeight) continue;
    cells.emplace_back(one.place().cells[effect], weight);
    found.mean += weight * cells.back().first.theta;
    of_reading[cells.back().first.reading] += weight;
  }
  found.reading =
      static_cast<std::size_t>(std::max_element(of_reading.begin(), of_reading.end()) - of_reading.begin());
  const auto below = [&](double theta) {
    double sum = 0.0;
    for (const auto& [cell, weight] : cells)
      sum += weight * std::clamp((theta - cell.theta) / cell.width + 0.5, 0.0, 1.0);
    return sum;
  };
  const auto quantile = [&](double share) {
    double low = reduced_[effect].lowest, high = reduced_[effect].highest;
    for (int step = 0; step < 40; ++step)
      (below(0.5 * (low + high)) < share ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  };
  found.interval_90 = {quantile(0.05), quantile(0.95)};
  return found;
}

}  // namespace pendular::diagnosis
