#include "diagnosis/evidence.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace pendular::diagnosis {
namespace {

constexpr int kGridOfOne = 121, kGridOfTwo = 31;
constexpr double kUnknownSigmas[] = {1.5, 3.0, 6.0};
constexpr double kLikeKnown = 0.25;  // of unknown mechanisms: as if an effect of the library acted

constexpr double kTogether = 0.15;  // of their geometric mean, by which two effects do not add

/// Features in units of their noise, believed inputs included, and the likelihood there.
class Whitened {
 public:
  explicit Whitened(const Gap& gap)
      : covariance_(gap.covariance + gap.believed * gap.believed.transpose()),
        factor_(covariance_),
        freedom_(gap.freedom),
        raw_(gap.values) {
    values_ = whiten(raw_);
    log_volume_ = log_volume_of(factor_);
  }

  Eigen::VectorXd whiten(const Eigen::VectorXd& v) const { return factor_.matrixL().solve(v); }
  const Eigen::VectorXd& values() const { return values_; }
  Eigen::Index size() const { return values_.size(); }

  /// Of a residual of this squared length, the noise's standard deviation being `widened`.
  double log_likelihood(double squared, double widened = 1.0) const {
    return density(squared / (widened * widened),
                   log_volume_ + static_cast<double>(size()) * std::log(widened));
  }

  struct Fit {
    double log_likelihood = 0.0, misfit = 0.0;
  };

  /// Of what a response leaves, where the response has these variances besides the noise.
  Fit fit(const Eigen::VectorXd& response, const Eigen::VectorXd& variance) const {
    Eigen::MatrixXd wider = covariance_;
    wider.diagonal() += variance;
    const Eigen::LLT<Eigen::MatrixXd> factor(wider);
    const double misfit = factor.matrixL().solve(raw_ - response).squaredNorm();
    return {density(misfit, log_volume_of(factor)), misfit};
  }

 private:
  static double log_volume_of(const Eigen::LLT<Eigen::MatrixXd>& factor) {
    return factor.matrixLLT().diagonal().array().log().sum();
  }

  double density(double squared, double log_volume) const {
    const double p = static_cast<double>(size());
    if (freedom_ <= 0.0) return -log_volume - 0.5 * squared - 0.5 * p * std::log(2.0 * M_PI);
    return -log_volume + std::lgamma(0.5 * (freedom_ + p)) - std::lgamma(0.5 * freedom_) -
           0.5 * p * std::log(M_PI * freedom_) - 0.5 * (freedom_ + p) * std::log1p(squared / freedom_);
  }

  Eigen::MatrixXd covariance_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double freedom_;
  Eigen::VectorXd raw_, values_;
  double log_volume_ = 0.0;
};

double log_sum(const std::vector<double>& terms) {
  const double largest = *std::max_element(terms.begin(), terms.end());
  if (!std::isfinite(largest)) return largest;
  double sum = 0.0;
  for (double term : terms) sum += std::exp(term - largest);
  return largest + std::log(sum);
}

/// A signature on a grid of magnitudes: its responses, and the prior's weights.
struct Grid {
  std::vector<double> theta, log_prior;
  std::vector<Eigen::VectorXd> response;
  std::vector<Eigen::VectorXd> variance;  // of the response
};

Grid grid_of(const Signature& signature, int points) {
  Grid grid;
  for (int k = 0; k < points; ++k) {
    const double theta =
        signature.lowest + (signature.highest - signature.lowest) * (k + 0.5) / static_cast<double>(points);
    grid.theta.push_back(theta);
    const bool absent = std::fabs(theta) < signature.least;
    grid.log_prior.push_back(absent ? -std::numeric_limits<double>::infinity() : 0.0);
    grid.response.push_back(signature.at(theta));
    grid.variance.push_back((signature.error * grid.response.back()).cwiseAbs2());
  }
  const double total = log_sum(grid.log_prior);
  for (double& log_prior : grid.log_prior) log_prior -= total;
  return grid;
}

/// Posterior of one magnitude from weights on its grid.
Magnitude magnitude_of(const Grid& grid, const std::vector<double>& log_weight) {
  const double total = log_sum(log_weight);
  const double cell = grid.theta.size() > 1 ? grid.theta[1] - grid.theta[0] : 0.0;
  Magnitude magnitude;
  double below = 0.0;
  const auto quantile = [&](double share, double weight, std::size_t k) {
    return grid.theta[k] + cell * ((share - below) / weight - 0.5);
  };
  for (std::size_t k = 0; k < grid.theta.size(); ++k) {
    const double weight = std::exp(log_weight[k] - total);
    magnitude.mean += weight * grid.theta[k];
    if (below < 0.05 && below + weight >= 0.05) magnitude.interval_90.first = quantile(0.05, weight, k);
    if (below < 0.95 && below + weight >= 0.95) magnitude.interval_90.second = quantile(0.95, weight, k);
    below += weight;
  }
  return magnitude;
}

Hypothesis none(const Whitened& space) {
  const double misfit = space.values().squaredNorm();
  return {"none", space.log_likelihood(misfit), 0.0, {}, misfit};
}

Hypothesis unknown(const Whitened& space) {
  const double misfit = space.values().squaredNorm();
  std::vector<double> terms;
  for (double sigmas : kUnknownSigmas)
    terms.push_back(space.log_likelihood(misfit, std::sqrt(1.0 + sigmas * sigmas)) - std::log(3.0));
  return {"unknown", log_sum(terms), 0.0, {}, misfit};
}

/// Evidence of `unknown`, some of which does what a known effect would do.
double with_likeness(double without_direction, const std::vector<Hypothesis>& all) {
  std::vector<double> like_known;
  for (const auto& h : all)
    if (h.magnitudes.size() == 1) like_known.push_back(h.log_evidence);
  if (like_known.empty()) return without_direction;
  const double mean = log_sum(like_known) - std::log(static_cast<double>(like_known.size()));
  return log_sum({without_direction + std::log(1.0 - kLikeKnown), mean + std::log(kLikeKnown)});
}

Hypothesis single(const Signature& signature, const Whitened& space) {
  const Grid grid = grid_of(signature, kGridOfOne);
  Hypothesis found{signature.id, 0.0, 0.0, {}, std::numeric_limits<double>::infinity()};
  std::vector<double> weight;
  for (std::size_t k = 0; k < grid.theta.size(); ++k) {
    const auto fit = space.fit(grid.response[k], grid.variance[k]);
    if (std::isfinite(grid.log_prior[k])) found.misfit = std::min(found.misfit, fit.misfit);
    weight.push_back(grid.log_prior[k] + fit.log_likelihood);
  }
  found.log_evidence = log_sum(weight);
  found.magnitudes = {magnitude_of(grid, weight)};
  return found;
}

Hypothesis pair(const std::string& id, const Grid& a, const Grid& b, const Whitened& space) {
  Hypothesis found{id, 0.0, 0.0, {}, std::numeric_limits<double>::infinity()};
  std::vector<std::vector<double>> of_a(a.theta.size()), of_b(b.theta.size());
  std::vector<double> all;
  for (std::size_t k = 0; k < a.theta.size(); ++k) {
    for (std::size_t l = 0; l < b.theta.size(); ++l) {
      const double log_prior = a.log_prior[k] + b.log_prior[l];
      const Eigen::VectorXd &one = a.response[k], &other = b.response[l];
      const auto fit = space.fit(one + other, a.variance[k] + b.variance[l] +
                                                  kTogether * kTogether * one.cwiseProduct(other).cwiseAbs());
      if (std::isfinite(log_prior)) found.misfit = std::min(found.misfit, fit.misfit);
      all.push_back(log_prior + fit.log_likelihood);
      of_a[k].push_back(all.back());
      of_b[l].push_back(all.back());
    }
  }
  found.log_evidence = log_sum(all);
  const auto marginal = [](const std::vector<std::vector<double>>& terms) {
    std::vector<double> sums;
    for (const auto& of_one : terms) sums.push_back(log_sum(of_one));
    return sums;
  };
  found.magnitudes = {magnitude_of(a, marginal(of_a)), magnitude_of(b, marginal(of_b))};
  return found;
}

/// Evidences times priors, made to sum to one; most probable first.
void make_probabilities(std::vector<Hypothesis>& hypotheses,
                        const std::function<double(const Hypothesis&)>& prior) {
  std::vector<double> log_weight;
  for (const auto& h : hypotheses) log_weight.push_back(h.log_evidence + std::log(prior(h)));
  const double total = log_sum(log_weight);
  for (std::size_t k = 0; k < hypotheses.size(); ++k)
    hypotheses[k].probability = std::exp(log_weight[k] - total);
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

}  // namespace

std::vector<Hypothesis> weigh(const Gap& gap, const std::vector<Signature>& signatures,
                              const Priors& priors) {
  const Whitened space(gap);
  std::vector<Hypothesis> all = {none(space), unknown(space)};
  std::vector<Grid> grids;
  for (const auto& signature : signatures) {
    all.push_back(single(signature, space));
    grids.push_back(grid_of(signature, kGridOfTwo));
  }
  for (std::size_t a = 0; a < signatures.size(); ++a)
    for (std::size_t b = a + 1; b < signatures.size(); ++b)
      all.push_back(pair(signatures[a].id + "+" + signatures[b].id, grids[a], grids[b], space));
  all[1].log_evidence = with_likeness(all[1].log_evidence, all);
  const double effects = static_cast<double>(signatures.size());
  const double pairs = effects > 1.0 ? priors.pairs : 0.0;
  make_probabilities(all, [&](const Hypothesis& h) {
    if (h.id == "none") return priors.none;
    if (h.id == "unknown") return priors.unknown;
    if (h.magnitudes.size() == 2) return pairs / (0.5 * effects * (effects - 1.0));
    return (1.0 - priors.none - priors.unknown - pairs) / effects;
  });
  return all;
}

Eigen::MatrixXd isolability(const Gap& gap, const std::vector<Signature>& signatures) {
  const Whitened space(gap);
  const auto size = static_cast<Eigen::Index>(signatures.size());
  Eigen::MatrixXd distance = Eigen::MatrixXd::Zero(size, size + 1);
  std::vector<Grid> grids;
  for (const auto& signature : signatures) grids.push_back(grid_of(signature, kGridOfOne));
  for (Eigen::Index a = 0; a < size; ++a) {
    const Eigen::VectorXd here = space.whiten(signatures[a].at(signatures[a].scale));
    distance(a, size) = here.squaredNorm();
    for (Eigen::Index b = 0; b < size; ++b) {
      if (a == b) continue;
      distance(a, b) = distance(a, size);
      for (const auto& there : grids[b].response)
        distance(a, b) = std::min(distance(a, b), (here - space.whiten(there)).squaredNorm());
    }
  }
  return distance;
}

}  // namespace pendular::diagnosis
