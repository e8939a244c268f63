#include "diagnosis/evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace pendular::diagnosis {
namespace {

constexpr int kGridOfOne = 81, kGridOfTwo = 11;
constexpr double kUnknownFactors[] = {1.5, 2.5, 4.0, 7.0};  // of the noise's standard deviation
constexpr double kLikeKnown = 0.25;  // of unknown mechanisms: as if an effect of the library acted
constexpr double kTogether = 0.15;   // of their geometric mean, by which two effects do not add
constexpr double kFreedom = 30.0;    // most that the likelihood trusts a covariance with
constexpr Eigen::Index kMostDirections = 45;
constexpr double kLeastDirection = 0.5;  // singular value, in units of the noise
constexpr double kLongest = 8.0;         // a response counts no more than this for the directions
constexpr int kSpanned = 3;              // magnitudes of each sign whose responses span
constexpr double kEverywhere = 0.3;      // share of a response's error that has no direction

/// Features in units of their noise, believed inputs included, reduced to what responses span.
class Space {
 public:
  Space(const Gap& gap, const std::vector<Signature>& signatures)
      : factor_(gap.covariance + gap.believed * gap.believed.transpose()),
        freedom_(gap.freedom > 0.0 ? std::min(gap.freedom, kFreedom) : 0.0) {
    find_directions(signatures);
    const Eigen::VectorXd whole = whiten(gap.values);
    values_ = directions_.transpose() * whole;
    outside_ = outside(gap.values);
    dimensions_ = static_cast<double>(whole.size() - values_.size());
    learn_outside(gap.outside);
  }

  Eigen::VectorXd reduced(const Eigen::VectorXd& v) const { return directions_.transpose() * whiten(v); }
  Eigen::MatrixXd reduced_covariance(const Eigen::MatrixXd& covariance) const {
    const Eigen::MatrixXd half = factor_.matrixL().solve(covariance);
    const Eigen::MatrixXd whole = factor_.matrixL().solve(half.transpose());
    return directions_.transpose() * whole * directions_;
  }
  const Eigen::VectorXd& values() const { return values_; }
  /// The square of what is outside the span.
  double outside(const Eigen::VectorXd& v) const {
    return std::max(0.0, whiten(v).squaredNorm() - reduced(v).squaredNorm());
  }
  Eigen::Index size() const { return values_.size(); }

  struct Fit {
    double log_likelihood = 0.0, misfit = 0.0, log_volume = 0.0;
  };

  /// Of what a response leaves, where the response has this covariance besides the noise.
  Fit fit(const Eigen::VectorXd& response, const Eigen::MatrixXd& covariance) const {
    Eigen::MatrixXd wider = covariance;
    wider.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> factor(wider);
    const double misfit = factor.matrixL().solve(values_ - response).squaredNorm();
    const double log_volume = factor.matrixLLT().diagonal().array().log().sum();
    return {density(misfit, log_volume) + log_outside(1.0), misfit, log_volume};
  }

  /// The same where the noise's standard deviation is so many times as large, outside the span, too.
  double widened(const Fit& fit, double factor) const {
    return density(fit.misfit / (factor * factor),
                   fit.log_volume + static_cast<double>(size()) * std::log(factor)) +
           log_outside(factor);
  }

 private:
  Eigen::VectorXd whiten(const Eigen::VectorXd& v) const { return factor_.matrixL().solve(v); }

  void find_directions(const std::vector<Signature>& signatures) {
    std::vector<Eigen::VectorXd> columns;
    for (const auto& signature : signatures)
      for (const double end : {signature.lowest, signature.highest})
        for (int k = 1; k <= kSpanned && end != 0.0; ++k) {
          const Eigen::VectorXd response = whiten(signature.at(end * k / kSpanned));
          const double length = response.norm();
          if (length > 0.0) columns.push_back(response * std::min(1.0, kLongest / length));
        }
    const Eigen::Index features = factor_.rows();
    directions_ = Eigen::MatrixXd::Identity(features, features);
    if (columns.empty() || features <= 2) return;
    Eigen::MatrixXd all(features, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(all, Eigen::ComputeThinU);
    Eigen::Index kept = 0;
    while (kept < std::min(kMostDirections, svd.singularValues().size()) &&
           svd.singularValues()[kept] > kLeastDirection)
      ++kept;
    if (kept > 0) directions_ = svd.matrixU().leftCols(kept);
  }

  /// What known runs leave outside is a multiple of χ², of their mean and variance; without runs, χ² itself.
  void learn_outside(const std::vector<double>& known) {
    outside_freedom_ = dimensions_;
    if (known.size() < 8 || dimensions_ <= 0.0) return;
    const double n = static_cast<double>(known.size());
    double mean = 0.0, square = 0.0;
    for (double one : known) mean += one / n;
    for (double one : known) square += (one - mean) * (one - mean) / (n - 1.0);
    if (!(mean > 0.0 && square > 0.0)) return;
    outside_scale_ = square / (2.0 * mean);
    outside_freedom_ = 2.0 * mean * mean / square;
  }

  double log_outside(double factor) const {
    if (dimensions_ <= 0.0) return 0.0;
    const double half = 0.5 * outside_freedom_, scale = outside_scale_ * factor * factor,
                 x = std::max(1e-9, outside_ / scale);
    return (half - 1.0) * std::log(x) - 0.5 * x - half * M_LN2 - std::lgamma(half) - std::log(scale);
  }

  double density(double squared, double log_volume) const {
    const double p = static_cast<double>(size());
    if (freedom_ <= 0.0) return -log_volume - 0.5 * squared - 0.5 * p * std::log(2.0 * M_PI);
    return -log_volume + std::lgamma(0.5 * (freedom_ + p)) - std::lgamma(0.5 * freedom_) -
           0.5 * p * std::log(M_PI * freedom_) - 0.5 * (freedom_ + p) * std::log1p(squared / freedom_);
  }

  Eigen::LLT<Eigen::MatrixXd> factor_;
  double freedom_;
  Eigen::MatrixXd directions_;  // orthonormal columns in the whitened features
  Eigen::VectorXd values_;
  double outside_ = 0.0, dimensions_ = 0.0;  // of the gap; outside the span
  double outside_scale_ = 1.0, outside_freedom_ = 1.0;
};

double log_sum(const std::vector<double>& terms) {
  const double largest = *std::max_element(terms.begin(), terms.end());
  if (!std::isfinite(largest)) return largest;
  double sum = 0.0;
  for (double term : terms) sum += std::exp(term - largest);
  return largest + std::log(sum);
}

/// A signature on a grid of magnitudes: its reduced responses, their covariances, and the prior's weights.
struct Grid {
  std::vector<double> theta, log_prior;
  std::vector<Eigen::VectorXd> response;
  std::vector<Eigen::MatrixXd> covariance;
};

Grid grid_of(const Signature& signature, const Space& space, int points) {
  Grid grid;
  Signature reduced = signature;
  for (auto& power : reduced.powers) power = space.reduced(power);
  const Eigen::MatrixXd draws =
      signature.draws.size() > 0 ? space.reduced_covariance(signature.draws) : Eigen::MatrixXd();
  for (int k = 0; k < points; ++k) {
    const double theta =
        signature.lowest + (signature.highest - signature.lowest) * (k + 0.5) / static_cast<double>(points);
    grid.theta.push_back(theta);
    const bool absent = std::fabs(theta) < signature.least;
    grid.log_prior.push_back(absent ? -std::numeric_limits<double>::infinity() : 0.0);
    grid.response.push_back(reduced.at(theta));
    const Eigen::VectorXd& response = grid.response.back();
    const double everywhere =
        kEverywhere * response.squaredNorm() / std::max<double>(1.0, static_cast<double>(response.size()));
    Eigen::MatrixXd covariance =
        (signature.error * signature.error * (response.array().square() + everywhere)).matrix().asDiagonal();
    if (draws.size() > 0) covariance += draws * std::pow(theta / signature.drawn_at, 2);
    grid.covariance.push_back(std::move(covariance));
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

/// An explanation, and what it would come to beside something unknown.
struct Weighed {
  Hypothesis hypothesis;
  double beside_unknown = 0.0;  // logarithm of the evidence with wider noise
};

/// Mean over the widths of the noise.
double beside_unknown(const Space& space, const Space::Fit& fit) {
  std::vector<double> terms;
  for (double factor : kUnknownFactors) terms.push_back(space.widened(fit, factor));
  return log_sum(terms) - std::log(static_cast<double>(std::size(kUnknownFactors)));
}

Weighed none(const Space& space) {
  const auto fit =
      space.fit(Eigen::VectorXd::Zero(space.size()), Eigen::MatrixXd::Zero(space.size(), space.size()));
  return {{"none", fit.log_likelihood, 0.0, {}, fit.misfit}, beside_unknown(space, fit)};
}

Weighed single(const Signature& signature, const Space& space) {
  const Grid grid = grid_of(signature, space, kGridOfOne);
  Weighed found{{signature.id, 0.0, 0.0, {}, std::numeric_limits<double>::infinity()}};
  std::vector<double> weight, beside;
  for (std::size_t k = 0; k < grid.theta.size(); ++k) {
    if (!std::isfinite(grid.log_prior[k])) {
      weight.push_back(grid.log_prior[k]);
      continue;
    }
    const auto fit = space.fit(grid.response[k], grid.covariance[k]);
    found.hypothesis.misfit = std::min(found.hypothesis.misfit, fit.misfit);
    weight.push_back(grid.log_prior[k] + fit.log_likelihood);
    beside.push_back(grid.log_prior[k] + beside_unknown(space, fit));
  }
  found.hypothesis.log_evidence = log_sum(weight);
  found.hypothesis.magnitudes = {magnitude_of(grid, weight)};
  found.beside_unknown = log_sum(beside);
  return found;
}

/// Something beside what is known, or, one time in four, something that does what a known effect would.
Hypothesis unknown(const std::vector<Weighed>& known) {
  std::vector<double> beside, like;
  for (const auto& one : known) {
    beside.push_back(one.beside_unknown);
    if (one.hypothesis.magnitudes.size() == 1) like.push_back(one.hypothesis.log_evidence);
  }
  const auto mean = [](const std::vector<double>& terms) {
    return log_sum(terms) - std::log(static_cast<double>(terms.size()));
  };
  const double other = mean(beside);
  if (like.empty()) return {"unknown", other, 0.0, {}, known.front().hypothesis.misfit};
  return {"unknown", log_sum({other + std::log(1.0 - kLikeKnown), mean(like) + std::log(kLikeKnown)}), 0.0, {},
          known.front().hypothesis.misfit};
}

Hypothesis pair(const std::string& id, const Grid& a, const Grid& b, const Space& space) {
  Hypothesis found{id, 0.0, 0.0, {}, std::numeric_limits<double>::infinity()};
  std::vector<std::vector<double>> of_a(a.theta.size()), of_b(b.theta.size());
  std::vector<double> all;
  for (std::size_t k = 0; k < a.theta.size(); ++k) {
    for (std::size_t l = 0; l < b.theta.size(); ++l) {
      const double log_prior = a.log_prior[k] + b.log_prior[l];
      double weight = log_prior;
      if (std::isfinite(log_prior)) {
        const Eigen::VectorXd &one = a.response[k], &other = b.response[l];
        Eigen::MatrixXd covariance = a.covariance[k] + b.covariance[l];
        covariance.diagonal() += kTogether * kTogether * one.cwiseProduct(other).cwiseAbs();
        const auto fit = space.fit(one + other, covariance);
        found.misfit = std::min(found.misfit, fit.misfit);
        weight += fit.log_likelihood;
      }
      all.push_back(weight);
      of_a[k].push_back(weight);
      of_b[l].push_back(weight);
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

std::vector<double> outside_of(const Gap& gap, const std::vector<Signature>& signatures,
                               const std::vector<Eigen::VectorXd>& values) {
  const Space space(gap, signatures);
  std::vector<double> squares;
  for (const auto& one : values) squares.push_back(space.outside(one));
  return squares;
}

Eigen::Index span_of(const Gap& gap, const std::vector<Signature>& signatures) {
  return Space(gap, signatures).size();
}

std::vector<Hypothesis> weigh(const Gap& gap, const std::vector<Signature>& signatures,
                              const Priors& priors) {
  const Space space(gap, signatures);
  std::vector<Weighed> known = {none(space)};
  std::vector<Grid> grids;
  for (const auto& signature : signatures) {
    known.push_back(single(signature, space));
    grids.push_back(grid_of(signature, space, kGridOfTwo));
  }
  std::vector<Hypothesis> all = {unknown(known)};
  for (const auto& one : known) all.push_back(one.hypothesis);
  for (std::size_t a = 0; a < signatures.size(); ++a)
    for (std::size_t b = a + 1; b < signatures.size(); ++b)
      all.push_back(pair(signatures[a].id + "+" + signatures[b].id, grids[a], grids[b], space));
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
  const Space space(gap, signatures);
  const auto size = static_cast<Eigen::Index>(signatures.size());
  Eigen::MatrixXd distance = Eigen::MatrixXd::Zero(size, size + 1);
  std::vector<Grid> grids;
  for (const auto& signature : signatures) grids.push_back(grid_of(signature, space, kGridOfOne));
  for (Eigen::Index a = 0; a < size; ++a) {
    const auto& signature = signatures[static_cast<std::size_t>(a)];
    const Eigen::VectorXd here = space.reduced(signature.at(signature.scale));
    distance(a, size) = here.squaredNorm();
    for (Eigen::Index b = 0; b < size; ++b) {
      if (a == b) continue;
      distance(a, b) = distance(a, size);
      for (const auto& there : grids[static_cast<std::size_t>(b)].response)
        distance(a, b) = std::min(distance(a, b), (here - there).squaredNorm());
    }
  }
  return distance;
}

}  // namespace pendular::diagnosis
