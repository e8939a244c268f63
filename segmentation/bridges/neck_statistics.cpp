#include "segmentation/bridges/neck_statistics.h"

#include "segmentation/thresholds.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pendular::segmentation {
namespace {

constexpr std::size_t kFiner = 5;  // points per tried share
constexpr double kLeastSd = 0.02;  // of radii, voxels
constexpr int kRounds = 4, kSteps = 60;

/// The evidence of one crevice on a fine grid of neck radii, by cubics through four neighbours (Catmull &
/// Rom).
struct FineEvidence {
  std::vector<double> radius, n, d;
};

double cubic(const std::vector<double>& values, std::size_t k, double share) {
  const auto at = [&](std::ptrdiff_t offset) {
    const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
    return values[static_cast<std::size_t>(
        std::clamp(static_cast<std::ptrdiff_t>(k) + offset, std::ptrdiff_t{0}, last))];
  };
  const double a = at(-1), b = at(0), c = at(1), d = at(2);
  return b +
         0.5 * share * (c - a + share * (2.0 * a - 5.0 * b + 4.0 * c - d + share * (3.0 * (b - c) + d - a)));
}

FineEvidence finer(const NeckEvidence& crevice, double radius) {
  const auto shares = neck_shares();
  FineEvidence fine;
  for (std::size_t k = 0; k + 1 < shares.size(); ++k)
    for (std::size_t m = 0; m < kFiner; ++m) {
      const double share = static_cast<double>(m) / kFiner;
      fine.radius.push_back(radius * (shares[k] + share * (shares[k + 1] - shares[k])));
      fine.n.push_back(cubic(crevice.n, k, share));
      fine.d.push_back(std::max(0.0, cubic(crevice.d, k, share)));
    }
  return fine;
}

/// What a crevice says with a contrast and a population: its likelihood over that without a neck, and the
/// moments of the radius if there is one.
struct Moments {
  double log_ratio = 0.0, mean = 0.0, square = 0.0;
};

Moments moments(const FineEvidence& fine, double contrast, double mean, double sd) {
  Moments found;
  std::vector<double> logs(fine.radius.size());
  double prior = 0.0, largest = -HUGE_VAL;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const double u = (fine.radius[k] - mean) / sd;
    prior += std::exp(-0.5 * u * u);
    logs[k] = contrast * fine.n[k] - 0.5 * contrast * contrast * fine.d[k] - 0.5 * u * u;
    largest = std::max(largest, logs[k]);
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const double weight = std::exp(logs[k] - largest);
    sum += weight, found.mean += weight * fine.radius[k],
        found.square += weight * fine.radius[k] * fine.radius[k];
  }
  found.mean /= sum, found.square /= sum;
  found.log_ratio = largest + std::log(sum) - std::log(std::max(prior, 1e-300));
  return found;
}

double probability_of(double log_ratio, double share) {
  return 1.0 / (1.0 + (1.0 - share) / share * std::exp(-std::min(log_ratio, 700.0)));
}

double gain_of(const std::vector<FineEvidence>& all, const NeckPopulation& p, double contrast) {
  double gain = 0.0;
  for (const auto& fine : all) {
    const double log_ratio = moments(fine, contrast, p.mean, p.sd).log_ratio;
    const double high = std::max(log_ratio, 0.0);
    gain += high + std::log(p.share * std::exp(log_ratio - high) + (1.0 - p.share) * std::exp(-high));
  }
  return gain;
}

/// The likeliest contrast, by golden sections between `low` and `high`.
double best_contrast(const std::vector<FineEvidence>& all, const NeckPopulation& p, double low, double high) {
  constexpr double golden = 0.6180339887498949;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = gain_of(all, p, a), at_b = gain_of(all, p, b);
  while (high - low > 1e-3) {
    if (at_a > at_b) {
      high = b, b = a, at_b = at_a, a = high - golden * (high - low), at_a = gain_of(all, p, a);
    } else {
      low = a, a = b, at_a = at_b, b = low + golden * (high - low), at_b = gain_of(all, p, b);
    }
  }
  return 0.5 * (low + high);
}

void fit_radii(const std::vector<FineEvidence>& all, NeckPopulation& p) {
  for (int step = 0; step < kSteps; ++step) {
    double weight = 0.0, sum = 0.0, square = 0.0;
    for (const auto& fine : all) {
      const Moments m = moments(fine, p.contrast, p.mean, p.sd);
      const double probability = probability_of(m.log_ratio, p.share);
      weight += probability, sum += probability * m.mean, square += probability * m.square;
    }
    const NeckPopulation before = p;
    p.share = std::clamp(weight / static_cast<double>(all.size()), 1e-3, 1.0 - 1e-3);
    if (weight < 1.0) return;
    p.mean = sum / weight;
    p.sd = std::max(kLeastSd, std::sqrt(std::max(0.0, square / weight - p.mean * p.mean)));
    if (std::fabs(p.mean - before.mean) + std::fabs(p.sd - before.sd) < 1e-4 * p.mean) return;
  }
}

}  // namespace

std::optional<NeckPopulation> neck_population(std::span<const NeckEvidence> crevices,
                                              std::span<const double> radii) {
  if (crevices.empty()) return std::nullopt;
  std::vector<FineEvidence> all;
  double mean_radius = 0.0;
  for (std::size_t k = 0; k < crevices.size(); ++k) {
    all.push_back(finer(crevices[k], radii[k]));
    mean_radius += radii[k] / static_cast<double>(crevices.size());
  }
  const auto shares = neck_shares();
  // Nothing is known of radii at first.
  NeckPopulation p{0.0, 0.0, 0.5, 0.5 * (shares.front() + shares.back()) * mean_radius, mean_radius, 0.0};
  p.contrast = best_contrast(all, p, 0.0, 1.5);
  for (int round = 0; round < kRounds && p.contrast > 1e-3; ++round) {
    fit_radii(all, p);
    p.contrast = best_contrast(all, p, std::max(0.0, 0.7 * p.contrast), 1.3 * p.contrast + 2e-3);
  }
  p.gain = gain_of(all, p, p.contrast);
  const double step = 0.02 * std::max(p.contrast, 0.01);
  const double curvature =
      (2.0 * p.gain - gain_of(all, p, p.contrast + step) - gain_of(all, p, p.contrast - step)) /
      (step * step);
  p.sigma_contrast = curvature > 0.0 ? 1.0 / std::sqrt(curvature) : HUGE_VAL;
  if (p.gain < kThresholds.neck_gain || p.contrast < kThresholds.neck_sigmas * p.sigma_contrast)
    return std::nullopt;
  return p;
}

NeckVerdict neck_verdict(const NeckEvidence& crevice, double radius, const NeckPopulation& population) {
  const Moments m = moments(finer(crevice, radius), population.contrast, population.mean, population.sd);
  return {probability_of(m.log_ratio, population.share), m.mean,
          std::sqrt(std::max(0.0, m.square - m.mean * m.mean))};
}

std::vector<BridgeState> neck_states(std::span<const double> probabilities, double false_discoveries) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<BridgeState> states(probabilities.size(), BridgeState::undetermined);
  const auto name = [&](BridgeState state, auto wrong) {
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::make_pair(wrong(a), a) < std::make_pair(wrong(b), b);
    });
    double sum = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k) {
      sum += wrong(order[k]);
      if (wrong(order[k]) > 0.5 || sum > false_discoveries * static_cast<double>(k + 1)) break;
      states[order[k]] = state;
    }
  };
  name(BridgeState::bridge, [&](std::size_t k) { return 1.0 - probabilities[k]; });
  name(BridgeState::none, [&](std::size_t k) { return probabilities[k]; });
  return states;
}

}  // namespace pendular::segmentation
