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

// Of a response's own covariance, in terms of standard deviations.
constexpr double kScale[] = {0.4, 0.63, 1.0, 1.6, 2.5}, kScaleWeights[] = {0.1, 0.24, 0.32, 0.24, 0.1};
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

// The likelihood is a product of both parts, so the sum over pairs of factors is one of products of sums.
double beside_unknown(const ReducedSpace& space, const ReducedGap& gap, const Predictions& predictions,
                      std::size_t lane, double chi_squared) {
  std::vector<double> within, outside;
  for (const double factor : kUnknownFactors) {
    within.push_back(space.log_within(predictions, lane, chi_squared, factor));
    outside.push_back(space.log_outside(predictions, lane, gap.outside, factor));
  }
  const double usual_outside = outside.front();
  const std::vector<double> wider_within(within.begin() + 1, within.end()),
      wider_outside(outside.begin() + 1, outside.end());
  return log_sum({log_sum(within) + log_sum(wider_outside), log_sum(wider_within) + usual_outside}) -
         std::log(static_cast<double>(within.size() * outside.size() - 1));
}

double MagnitudeGrid::Fitted::log_density() const {
  double density = log_weight();
  for (const auto& cell : place().cells) density -= std::log(cell.width);
  return density;
}

void MagnitudeGrid::fit(const Batch& batch, const ReducedGap& gap, std::vector<Fitted>& to) const {
  static_assert(std::size(kScale) == kScales && std::size(kScaleWeights) == kScales);
  std::array<Fits, kScales> fits;
  for (std::size_t k = 0; k < kScales; ++k) fits[k] = space_.fit(gap, batch.predictions[k]);
  for (std::size_t lane = 0; lane < batch.places.size(); ++lane) {
    Fitted fitted{&batch, lane};
    std::vector<double> terms;
    for (std::size_t k = 0; k < kScales; ++k) {
      fitted.chi_squareds[k] = fits[k].chi_squared[lane];
      terms.push_back(std::log(kScaleWeights[k]) + fits[k].log_likelihood[lane]);
    }
    fitted.log_likelihood = log_sum(terms);
    to.push_back(fitted);
  }
}

std::vector<std::vector<MagnitudeGrid::Fitted>> MagnitudeGrid::fit(const std::vector<ReducedGap>& gaps) {
  std::vector<std::vector<Fitted>> fitted(gaps.size());
  for (auto& batch : batches_) {
    for (std::size_t k = 0; k < gaps.size(); ++k) fit(batch, gaps[k], fitted[k]);
    for (auto& prediction : batch.predictions) prediction.factors = LaneFactors(0);
  }
  return fitted;
}

MagnitudeGrid::MagnitudeGrid(std::vector<Signature> reduced, std::optional<Together> together,
                             const ReducedSpace& space)
    : reduced_(std::move(reduced)), together_(std::move(together)), space_(space) {
  std::vector<Cell> whole;
  for (const auto& one : reduced_)
    whole.push_back({0.5 * (one.lowest + one.highest), one.highest - one.lowest});
  batches_ = batches_at(parts_of(whole, reduced_.size() > 1 ? kCellsOfTwo : kCellsOfOne));
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

std::vector<MagnitudeGrid::Batch> MagnitudeGrid::batches_at(const std::vector<std::vector<Cell>>& all) const {
  std::vector<Place> places;
  for (const auto& cells : all) {
    double log_prior = 0.0;
    for (std::size_t e = 0; e < cells.size(); ++e)
      log_prior += log_prior_of(reduced_[e], cells[e].theta, cells[e].width);
    if (log_prior != kNever) places.push_back({cells, log_prior});
  }
  std::vector<Batch> batches;
  for (std::size_t first = 0; first < places.size(); first += kLanes) {
    Batch batch;
    std::vector<Expected> all_expected;
    for (std::size_t k = first; k < std::min(first + kLanes, places.size()); ++k) {
      all_expected.push_back(expected(places[k].cells));
      batch.places.push_back(std::move(places[k]));
    }
    for (const double scale : kScale) batch.predictions.push_back(space_.predict(all_expected, scale));
    batches.push_back(std::move(batch));
  }
  return batches;
}

/// What one effect does, or two together, and how it is known.
Expected MagnitudeGrid::expected(const std::vector<Cell>& cells) const {
  const Eigen::Index size = space_.size();
  Expected found{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
  Eigen::VectorXd product = Eigen::VectorXd::Constant(size, cells.size() > 1 ? 1.0 : 0.0);
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const double theta = cells[e].theta;
    const Eigen::VectorXd response = reduced_[e].at(theta);
    found.response += response;
    product = product.cwiseProduct(response);
    found.shares += variance_of(reduced_[e], response);
    found.outside += std::pow(reduced_[e].outside, 2) * response.squaredNorm();
    const Response& here = reduced_[e].response(theta);
    if (here.draws.size() == 0) continue;
    const double grown = here.grown(theta);
    found.draws.emplace_back(&here.draws, grown);
    found.drawn_outside += grown * here.drawn_outside;
    found.dof = found.dof > 0.0 ? std::min(found.dof, here.drawn_dof) : here.drawn_dof;
  }
  if (together_) {
    const double grown = cells[0].theta / together_->theta_a * cells[1].theta / together_->theta_b;
    found.response += grown * together_->beyond;
    if (together_->error.size() > 0) found.draws.emplace_back(&together_->error, grown * grown);
  }
  found.shares +=
      std::pow(together_ ? kThresholds.run_together : kThresholds.together, 2) * product.cwiseAbs();
  return found;
}

double MagnitudeGrid::evidence_of(const std::vector<Fitted>& fitted) {
  std::vector<double> weights = {kNever};
  for (const auto& one : fitted) weights.push_back(one.log_weight());
  return log_sum(weights);
}

Weighed MagnitudeGrid::weigh(const ReducedGap& gap, std::vector<Fitted> fitted, double least,
                             bool beside) const {
  std::deque<std::vector<Batch>> finer;  // outlives what points into it
  const int rounds = evidence_of(fitted) >= least ? kRefined : 0;
  for (int round = 0; round < rounds && !fitted.empty(); ++round) {
    const auto best =
        std::max_element(fitted.begin(), fitted.end(),
                         [](const Fitted& a, const Fitted& b) { return a.log_density() < b.log_density(); })
            ->place()
            .cells;
    std::vector<std::vector<Cell>> cut;
    std::erase_if(fitted, [&](const Fitted& one) {
      const auto& cells = one.place().cells;
      for (std::size_t e = 0; e < best.size(); ++e)
        if (std::fabs(cells[e].theta - best[e].theta) > 0.75 * (cells[e].width + best[e].width)) return false;
      const auto parts = parts_of(cells, kParts);
      cut.insert(cut.end(), parts.begin(), parts.end());
      return true;
    });
    for (const auto& batch : finer.emplace_back(batches_at(cut))) fit(batch, gap, fitted);
  }

  Weighed found;
  Hypothesis& hypothesis = found.hypothesis;
  hypothesis.chi_squared = std::numeric_limits<double>::infinity();
  std::vector<double> wider = {kNever};
  for (const auto& one : fitted) {
    if (beside)
      for (std::size_t k = 0; k < kScales; ++k)
        wider.push_back(
            one.place().log_prior + std::log(kScaleWeights[k]) +
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
  Magnitude found;
  for (const auto& one : fitted) {
    cells.emplace_back(one.place().cells[effect], std::exp(one.log_weight() - log_evidence));
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
