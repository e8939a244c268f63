#include "diagnosis/inference/magnitude_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

#include "diagnosis/inference/log_sum.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr double kScales[] = {0.4, 0.63, 1.0, 1.6,
                              2.5};  // of the standard deviations of a response's own covariance
constexpr double kScaleWeights[] = {0.1, 0.24, 0.32, 0.24, 0.1};
constexpr int kCellsOfOne = 41, kCellsOfTwo = 11;  // of each effect's range
constexpr int kRefined = 3, kParts = 4;            // how often cells at the peak are cut, and into how many
constexpr double kUnknownFactors[] = {1.0, 1.5, 2.5, 4.0, 7.0};  // of the noise's standard deviation
constexpr double kNever = -std::numeric_limits<double>::infinity();

/// All magnitudes are alike a priori, those below the least one aside.
double log_prior_of(const Signature& signature, double theta, double width) {
  if (std::fabs(theta) < signature.least) return kNever;
  const double absent = std::max(
      0.0, std::min(signature.highest, signature.least) - std::max(signature.lowest, -signature.least));
  return std::log(width / (signature.highest - signature.lowest - absent));
}

/// How a reduced response is known by any run: to a share of itself.
Eigen::VectorXd variance_of(const Signature& reduced, const Eigen::VectorXd& response) {
  const double everywhere = kThresholds.everywhere * response.squaredNorm() /
                            std::max<double>(1.0, static_cast<double>(response.size()));
  return reduced.error * reduced.error * (response.array().square() + everywhere);
}

}  // namespace

double beside_unknown(const ReducedSpace& space, const ReducedGap& gap, const Prediction& prediction,
                      double chi_squared) {
  std::vector<double> terms;
  for (double within : kUnknownFactors)
    for (double outside : kUnknownFactors)
      if (within > 1.0 || outside > 1.0)
        terms.push_back(space.widened(gap, prediction, chi_squared, within, outside));
  return log_sum(terms) - std::log(static_cast<double>(terms.size()));
}

struct MagnitudeGrid::Fitted {
  const Place* place;
  double log_likelihood = 0.0;
  std::array<double, std::size(kScales)> chi_squareds = {};

  double log_weight() const { return place->log_prior + log_likelihood; }
  double log_density() const {
    double density = log_weight();
    for (const auto& cell : place->cells) density -= std::log(cell.width);
    return density;
  }
};

MagnitudeGrid::Fitted MagnitudeGrid::fit(const Place& place, const ReducedGap& gap) const {
  Fitted fitted{&place};
  std::vector<double> terms;
  for (std::size_t k = 0; k < std::size(kScales); ++k) {
    const Fit one = space_.fit(gap, place.predictions[k]);
    fitted.chi_squareds[k] = one.chi_squared;
    terms.push_back(std::log(kScaleWeights[k]) + one.log_likelihood);
  }
  fitted.log_likelihood = log_sum(terms);
  return fitted;
}

MagnitudeGrid::MagnitudeGrid(std::vector<Signature> reduced, std::optional<Together> together,
                             const ReducedSpace& space)
    : reduced_(std::move(reduced)), together_(std::move(together)), space_(space) {
  std::vector<Cell> whole;
  for (const auto& one : reduced_)
    whole.push_back({0.5 * (one.lowest + one.highest), one.highest - one.lowest});
  places_ = places_at(parts_of(whole, reduced_.size() > 1 ? kCellsOfTwo : kCellsOfOne));
}

/// One or two cells, each cut into so many.
std::vector<std::vector<MagnitudeGrid::Cell>> MagnitudeGrid::parts_of(const std::vector<Cell>& cells,
                                                                      int parts) {
  std::vector<std::vector<Cell>> found = {{}};
  for (const auto& cell : cells) {
    std::vector<std::vector<Cell>> longer;
    for (const auto& so_far : found)
      for (int k = 0; k < parts; ++k) {
        longer.push_back(so_far);
        longer.back().push_back({cell.theta + cell.width * ((k + 0.5) / parts - 0.5), cell.width / parts});
      }
    found = std::move(longer);
  }
  return found;
}

std::vector<MagnitudeGrid::Place> MagnitudeGrid::places_at(const std::vector<std::vector<Cell>>& all) const {
  std::vector<Place> places;
  for (const auto& cells : all) {
    double log_prior = 0.0;
    for (std::size_t e = 0; e < cells.size(); ++e)
      log_prior += log_prior_of(reduced_[e], cells[e].theta, cells[e].width);
    if (log_prior != kNever) places.push_back({cells, log_prior, predict(cells)});
  }
  return places;
}

std::vector<Prediction> MagnitudeGrid::predict(const std::vector<Cell>& cells) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(space_.size());
  Eigen::VectorXd product = Eigen::VectorXd::Constant(space_.size(), cells.size() > 1 ? 1.0 : 0.0);
  Errors errors{Eigen::VectorXd::Zero(space_.size()), Eigen::MatrixXd::Zero(space_.size(), space_.size())};
  double drawn_outside = 0.0;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const double theta = cells[e].theta;
    const Eigen::VectorXd response = reduced_[e].at(theta);
    sum += response;
    product = product.cwiseProduct(response);
    errors.shares += variance_of(reduced_[e], response);
    errors.outside += std::pow(reduced_[e].outside, 2) * response.squaredNorm();
    const Response& here = reduced_[e].response(theta);
    if (here.draws.size() == 0) continue;
    const double grown = here.grown(theta);
    errors.draws += grown * here.draws;
    drawn_outside += grown * here.drawn_outside;
    errors.dof = errors.dof > 0.0 ? std::min(errors.dof, here.drawn_dof) : here.drawn_dof;
  }
  if (together_) {
    const double grown = cells[0].theta / together_->theta_a * cells[1].theta / together_->theta_b;
    sum += grown * together_->beyond;
    if (together_->error.size() > 0) errors.draws += grown * grown * together_->error;
  }
  errors.shares +=
      std::pow(together_ ? kThresholds.run_together : kThresholds.together, 2) * product.cwiseAbs();
  std::vector<Prediction> found;
  for (const double scale : kScales) {
    Errors scaled = errors;
    scaled.draws *= scale * scale;
    scaled.outside += scale * scale * drawn_outside;
    found.push_back(space_.predict(sum, scaled));
  }
  return found;
}

double MagnitudeGrid::evidence_of(const std::vector<Fitted>& fitted) {
  std::vector<double> weights = {kNever};
  for (const auto& one : fitted) weights.push_back(one.log_weight());
  return log_sum(weights);
}

double MagnitudeGrid::coarse_evidence(const ReducedGap& gap) const {
  std::vector<Fitted> fitted;
  for (const auto& place : places_) fitted.push_back(fit(place, gap));
  return evidence_of(fitted);
}

Weighed MagnitudeGrid::weigh(const ReducedGap& gap, double least) const {
  std::vector<Fitted> fitted;
  std::deque<std::vector<Place>> finer;  // outlives what points into it
  const auto add = [&](const std::vector<Place>& places) {
    for (const auto& place : places) fitted.push_back(fit(place, gap));
  };
  add(places_);
  const int rounds = evidence_of(fitted) >= least ? kRefined : 0;
  for (int round = 0; round < rounds && !fitted.empty(); ++round) {
    const auto best = std::max_element(fitted.begin(), fitted.end(), [](const Fitted& a, const Fitted& b) {
                        return a.log_density() < b.log_density();
                      })->place->cells;
    std::vector<std::vector<Cell>> cut;
    std::erase_if(fitted, [&](const Fitted& one) {
      const auto& cells = one.place->cells;
      for (std::size_t e = 0; e < best.size(); ++e)
        if (std::fabs(cells[e].theta - best[e].theta) > 0.75 * (cells[e].width + best[e].width)) return false;
      const auto parts = parts_of(cells, kParts);
      cut.insert(cut.end(), parts.begin(), parts.end());
      return true;
    });
    add(finer.emplace_back(places_at(cut)));
  }

  Weighed found;
  Hypothesis& hypothesis = found.hypothesis;
  hypothesis.chi_squared = std::numeric_limits<double>::infinity();
  std::vector<double> beside = {kNever};
  for (const auto& one : fitted) {
    if (reduced_.size() == 1)  // pairs have no part in it
      for (std::size_t k = 0; k < std::size(kScales); ++k)
        beside.push_back(one.place->log_prior + std::log(kScaleWeights[k]) +
                         beside_unknown(space_, gap, one.place->predictions[k], one.chi_squareds[k]));
    hypothesis.chi_squared = std::min(hypothesis.chi_squared, one.chi_squareds[std::size(kScales) / 2]);
  }
  hypothesis.log_evidence = evidence_of(fitted), found.beside_unknown = log_sum(beside);
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
  Magnitude found;
  for (const auto& one : fitted) {
    cells.emplace_back(one.place->cells[effect], std::exp(one.log_weight() - log_evidence));
    found.mean += cells.back().second * cells.back().first.theta;
  }
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
