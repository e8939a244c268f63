#include "diagnosis/inference/reduced_space.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

#include "base/eigensystem.h"
#include "diagnosis/inference/gap.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr double kLeastLog = -20.7;  // of what is outside the span, over its scale
constexpr Eigen::Index kMostDirections = 45;
constexpr int kSpanned = 3;  // magnitudes of each sign whose responses span
constexpr Eigen::Index kLeastRows =
    3;  // from which the variance in directions that none of them shows is learnt
constexpr std::size_t kLeastKnown = 8;  // runs from which what is outside is learnt

/// Variance per direction of what each row has outside the span of the others.
double in_fresh_directions(const Eigen::MatrixXd& rows) {
  const Eigen::Index n = rows.rows();
  if (rows.cols() <= n) return 0.0;
  double sum = 0.0;
  for (Eigen::Index r = 0; r < n; ++r) {
    Eigen::MatrixXd others(rows.cols(), n - 1);
    for (Eigen::Index k = 0, at = 0; k < n; ++k)
      if (k != r) others.col(at++) = rows.row(k).transpose();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(others);
    const Eigen::VectorXd turned = qr.householderQ().transpose() * rows.row(r).transpose();
    sum += turned.tail(rows.cols() - n + 1).squaredNorm();
  }
  return sum / static_cast<double>(n * (rows.cols() - n + 1));
}

}  // namespace

ReducedSpace::ReducedSpace(const Gap& gap, const std::vector<Signature>& signatures)
    : factor_(whole_covariance(gap)),
      precision_(factor_.solve(Eigen::MatrixXd::Identity(factor_.rows(), factor_.rows()))),
      dof_(gap.dof > 0.0 ? std::min(gap.dof, kThresholds.most_dof) : 0.0),
      exact_(gap.exact) {
  find_directions(signatures);
  dimensions_ = static_cast<double>(factor_.rows() - size());
  learn_outside(gap.outside);
  log_chi_ = 0.5 * outside_dof_ * M_LN2 + std::lgamma(0.5 * outside_dof_);
}

void ReducedSpace::reduce(Response& response) const {
  for (auto& power : response.powers) power = reduced(power);
  if (response.early.size() > 0) response.early = reduced(response.early);
  if (response.draws.size() == 0) return;
  const double whole = response.draws.cwiseProduct(precision_).sum();  // the trace, in units of the noise
  response.draws = reduced_covariance(response.draws);
  response.drawn_outside = std::max(0.0, whole - response.draws.trace());
  const Eigen::Index free = inexact();
  response.draws.rightCols(size() - free).setZero(), response.draws.bottomRows(size() - free).setZero();
  if (response.missed.rows() < kLeastRows) return;
  Eigen::MatrixXd rows(response.missed.rows(), free);
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    rows.row(r) = reduced(response.missed.row(r).transpose()).head(free).transpose();
  const double scatter =
      reduced_covariance(response.scatter).diagonal().head(free).sum() / static_cast<double>(free);
  response.draws.diagonal().head(free).array() += std::max(0.0, in_fresh_directions(rows) - scatter);
  response.missed = {}, response.scatter = {};
}

Signature ReducedSpace::reduced(Signature signature) const {
  reduce(signature);
  if (signature.below) reduce(*signature.below);
  for (auto& other : signature.others) reduce(other);
  return signature;
}

ReducedGap ReducedSpace::gap(const Eigen::VectorXd& values) const {
  const double square = outside(values);
  return {reduced(values), square, std::log(square)};
}

// The reducer is Qᵀ L⁻¹ of orthonormal directions Q and the noise's factor L: L Q is L Lᵀ times its
// transpose.
Eigen::VectorXd ReducedSpace::spanned(const Eigen::VectorXd& coordinates) const {
  const Eigen::VectorXd pulled = reducer_.topRows(coordinates.size()).transpose() * coordinates;
  return factor_.matrixL() * Eigen::VectorXd(factor_.matrixU() * pulled);
}

double ReducedSpace::outside(const Eigen::VectorXd& v) const {
  return std::max(0.0, whiten(v).squaredNorm() - reduced(v).squaredNorm());
}

std::vector<LaneNumbers> responses_of(std::span<const Expected> expected) {
  std::vector<LaneNumbers> found(static_cast<std::size_t>(expected.front().response.size()));
  for (std::size_t k = 0; k < found.size(); ++k)
    for (std::size_t lane = 0; lane < expected.size(); ++lane)
      found[k][lane] = expected[lane].response[static_cast<Eigen::Index>(k)];
  return found;
}

Predictions ReducedSpace::predict(std::span<const Expected> expected, double scale, Workspace& room) const {
  const double p = static_cast<double>(size()), variance = scale * scale;
  Predictions found{expected.size(), {}, {}, {}, {}};
  LaneFactors& factors = room.factors;
  factors.reset();
  std::vector<std::pair<const Eigen::MatrixXd*, LaneNumbers>> draws;
  const auto times_of = [&](const Eigen::MatrixXd* covariance) -> LaneNumbers& {
    for (auto& [known, times] : draws)
      if (known == covariance) return times;
    return draws.emplace_back(covariance, LaneNumbers{}).second;
  };
  for (std::size_t lane = 0; lane < expected.size(); ++lane) {
    const Expected& one = expected[lane];
    factors.add_diagonal(lane, one.shares);
    double drawn = 0.0;
    for (const auto& [covariance, times] : one.draws) {
      times_of(covariance)[lane] += times * variance;
      drawn += times * variance * covariance->trace();
    }
    found.dof[lane] = dof_;
    // Welch and Satterthwaite: noise and draws are known by different numbers of runs.
    const double share = drawn / (drawn + one.shares.sum() + p);
    if (dof_ > 0.0 && one.dof > 0.0)
      found.dof[lane] = 1.0 / (share * share / one.dof + (1.0 - share) * (1.0 - share) / dof_);
    const double outside = one.outside + variance * one.drawn_outside;
    found.widening[lane] =
        dimensions_ > 0.0 ? std::sqrt(1.0 + outside / (outside_scale_ * outside_dof_)) : 1.0;
    found.log_widening[lane] = std::log(found.widening[lane]);
  }
  for (const auto& [covariance, times] : draws) factors.add(*covariance, times);
  factors.factor();
  const LaneNumbers half_log = factors.half_log_determinants();
  for (std::size_t lane = 0; lane < expected.size(); ++lane) {
    const double nu = found.dof[lane];
    found.log_volume[lane] =
        half_log[lane] +
        (nu <= 0.0 ? 0.5 * p * std::log(2.0 * M_PI)
                   : 0.5 * p * std::log(M_PI * nu) + std::lgamma(0.5 * nu) - std::lgamma(0.5 * (nu + p)));
  }
  return found;
}

Fits ReducedSpace::fit(const ReducedGap& gap, const std::vector<LaneNumbers>& responses,
                       const Predictions& predictions, Workspace& room) const {
  for (std::size_t k = 0; k < responses.size(); ++k)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      room.missed[k][lane] = gap.within[static_cast<Eigen::Index>(k)] - responses[k][lane];
  Fits fits{{}, room.factors.squared(room.missed, room.solved)};
  for (std::size_t lane = 0; lane < predictions.size; ++lane)
    fits.log_likelihood[lane] =
        log_within(predictions, lane, fits.chi_squared[lane], 1.0) + log_outside(predictions, lane, gap, 1.0);
  return fits;
}

double ReducedSpace::log_within(const Predictions& predictions, std::size_t lane, double chi_squared,
                                double factor) const {
  const double p = static_cast<double>(size()), nu = predictions.dof[lane],
               squared = chi_squared / (factor * factor);
  return -predictions.log_volume[lane] - p * std::log(factor) -
         (nu <= 0.0 ? 0.5 * squared : 0.5 * (nu + p) * std::log1p(squared / nu));
}

// The density is wanted of many gaps: what logarithms it has are of the gap or of the prediction.
double ReducedSpace::log_outside(const Predictions& predictions, std::size_t lane, const ReducedGap& gap,
                                 double factor) const {
  if (dimensions_ <= 0.0) return 0.0;
  const double wider = factor * predictions.widening[lane], scale = outside_scale_ * wider * wider,
               log_scale = log_outside_scale_ + 2.0 * (std::log(factor) + predictions.log_widening[lane]);
  return (0.5 * outside_dof_ - 1.0) * std::max(kLeastLog, gap.log_outside - log_scale) -
         0.5 * gap.outside / scale - log_chi_ - log_scale;
}

void ReducedSpace::find_directions(const std::vector<Signature>& signatures) {
  std::vector<Eigen::VectorXd> columns;
  for (const auto& signature : signatures)
    for (const double end : {signature.lowest, signature.highest})
      for (int k = 1; k <= kSpanned && end != 0.0; ++k)
        for (std::size_t reading = 0; reading < signature.readings(); ++reading) {
          const double theta = end * k / kSpanned;
          Eigen::VectorXd response = whiten(signature.response(theta, reading).at(theta));
          response(exact_).setZero();
          const double length = response.norm();
          if (length > 0.0) columns.push_back(response * std::min(1.0, kThresholds.longest / length));
        }
  const Eigen::Index features = factor_.rows();
  std::vector<Eigen::Index> others;
  for (Eigen::Index f = 0; f < features; ++f)
    if (std::find(exact_.begin(), exact_.end(), f) == exact_.end()) others.push_back(f);
  const Eigen::MatrixXd each = Eigen::MatrixXd::Identity(features, features);
  Eigen::MatrixXd directions = each(Eigen::all, others);
  if (!columns.empty() && features > 2) {
    Eigen::MatrixXd all(features, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
    // Singular values that count are a hundredth of the largest and more: their squares are exact enough.
    const auto [squares, vectors] = eigensystem(all.transpose() * all);
    Eigen::Index kept = 0;
    const Eigen::Index most = std::min({kMostDirections, features, all.cols()});
    while (kept < most && squares[all.cols() - 1 - kept] > std::pow(kThresholds.least_direction, 2)) ++kept;
    if (kept > 0) {
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(all * vectors.rightCols(kept).rowwise().reverse());
      directions = qr.householderQ() * Eigen::MatrixXd::Identity(features, kept);
    }
  }
  Eigen::MatrixXd with_exact(features, directions.cols() + static_cast<Eigen::Index>(exact_.size()));
  with_exact << directions, each(Eigen::all, exact_);
  reducer_ = factor_.matrixU().solve(with_exact).transpose();
}

// What known runs leave outside is a multiple of χ², of their mean and variance; without runs, χ² itself.
void ReducedSpace::learn_outside(const std::vector<double>& known) {
  outside_dof_ = dimensions_;
  if (known.size() < kLeastKnown || dimensions_ <= 0.0) return;
  const double n = static_cast<double>(known.size());
  double mean = 0.0, square = 0.0;
  for (double one : known) mean += one / n;
  for (double one : known) square += (one - mean) * (one - mean) / (n - 1.0);
  if (!(mean > 0.0 && square > 0.0)) return;
  outside_scale_ = kThresholds.fresh * square / (2.0 * mean);
  log_outside_scale_ = std::log(outside_scale_);
  outside_dof_ = 2.0 * mean * mean / square;
}

}  // namespace pendular::diagnosis
