#include "diagnosis/repair/place_misfit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/parallel.h"
#include "base/random.h"
#include "diagnosis/thresholds.h"
#include "packing/bridges.h"

namespace pendular::diagnosis {
namespace {

constexpr double kNeighbours = 0.064;  // gap up to which beads are a pair, over the diameter
constexpr double kAbout = 1.3;         // reach of a bead's surroundings, diameters
constexpr int kDraws = 3;              // of noise for each member
constexpr double kOfNoise = 0.866;     // exp⟨ln(1 + z²)⟩ − 1 of normal noise in three components

/// The pairs of neighbours, the variance of a component of their parting, and which are about each bead.
struct Surroundings {
  std::vector<Bridge> pairs;
  std::vector<double> variance;
  std::vector<std::vector<int>> about;
};

Vec3 parting(const Bridge& pair, const std::vector<Vec3>& u) {
  return u[static_cast<std::size_t>(pair.i)] - u[static_cast<std::size_t>(pair.j)];
}

Surroundings surroundings_of(const MovedBeads& beads) {
  std::vector<Bead> points(beads.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    points[k].centre = beads.rest[k], points[k].diameter = beads.diameter;
  Surroundings found{candidate_bridges(points, kNeighbours * beads.diameter), {}, {}};
  const auto mean = mean_member(beads);
  const double members = static_cast<double>(beads.members.size());
  std::vector<Vec3> middles;
  for (const auto& pair : found.pairs) {
    double square = 0.0;
    for (const auto& member : beads.members)
      square += (parting(pair, member) - parting(pair, mean)).squaredNorm() / (3.0 * (members - 1.0));
    found.variance.push_back(2.0 * beads.sigma * beads.sigma + (1.0 + 1.0 / members) * square);
    middles.push_back(0.5 * (points[static_cast<std::size_t>(pair.i)].centre +
                             points[static_cast<std::size_t>(pair.j)].centre));
  }
  found.about.resize(beads.size());
  const double reach = kAbout * beads.diameter;
  for_blocks(beads.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      for (std::size_t p = 0; p < middles.size(); ++p)
        if ((middles[p] - beads.rest[k]).squaredNorm() < reach * reach)
          found.about[k].push_back(static_cast<int>(p));
  });
  return found;
}

/// ⟨ln(1 + z²)⟩ over the pairs about a bead without the one bead that adds most to it.
double without_worst_bead(const Surroundings& surroundings, const std::vector<double>& logarithm,
                          const std::vector<int>& about) {
  std::map<int, std::pair<double, int>> of_bead;
  double sum = 0.0;
  for (int p : about) {
    const double value = logarithm[static_cast<std::size_t>(p)];
    const Bridge& pair = surroundings.pairs[static_cast<std::size_t>(p)];
    sum += value;
    for (int bead : {pair.i, pair.j}) of_bead[bead].first += value, ++of_bead[bead].second;
  }
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [bead, part] : of_bead) {
    const double left = static_cast<double>(about.size()) - part.second;
    if (left > 0.0) least = std::min(least, (sum - part.first) / left);
  }
  return least;
}

std::vector<double> values_of(const Surroundings& surroundings, const std::vector<Vec3>& difference) {
  std::vector<double> logarithm;
  for (std::size_t p = 0; p < surroundings.pairs.size(); ++p)
    logarithm.push_back(std::log1p(parting(surroundings.pairs[p], difference).squaredNorm() /
                                   (3.0 * surroundings.variance[p])));
  std::vector<double> values(surroundings.about.size(), 1.0);
  for_blocks(values.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const double mean = without_worst_bead(surroundings, logarithm, surroundings.about[k]);
      if (std::isfinite(mean)) values[k] = std::sqrt(std::expm1(mean) / kOfNoise);
    }
  });
  return values;
}

}  // namespace

std::vector<Vec3> mean_member(const MovedBeads& beads) {
  std::vector<Vec3> mean(beads.size(), Vec3::Zero());
  for (const auto& member : beads.members)
    for (std::size_t k = 0; k < mean.size(); ++k)
      mean[k] += member[k] / static_cast<double>(beads.members.size());
  return mean;
}

std::vector<double> member_variance(const MovedBeads& beads) {
  const auto mean = mean_member(beads);
  const double members = static_cast<double>(beads.members.size());
  std::vector<double> variance(beads.size(), 0.0);
  for (const auto& member : beads.members)
    for (std::size_t k = 0; k < mean.size(); ++k)
      variance[k] += (1.0 + 1.0 / members) * (member[k] - mean[k]).squaredNorm() / (3.0 * (members - 1.0));
  return variance;
}

std::vector<std::vector<Vec3>> null_differences(const MovedBeads& beads, int draws) {
  const auto mean = mean_member(beads);
  const double members = static_cast<double>(beads.members.size());
  const double others = members > 1.0 ? members / (members - 1.0) : 1.0;  // less their mean, not that of all
  std::vector<std::vector<Vec3>> all;
  for (int draw = 0; draw < draws; ++draw)
    for (const auto& member : beads.members) {
      const auto seed = static_cast<std::uint64_t>(all.size());
      std::vector<Vec3> difference(beads.size());
      for (std::size_t k = 0; k < difference.size(); ++k) {
        difference[k] = others * (member[k] - mean[k]);
        for (int axis = 0; axis < 3; ++axis)
          difference[k][axis] += beads.sigma * random_normal(seed, 3 * k + static_cast<unsigned>(axis));
      }
      all.push_back(std::move(difference));
    }
  return all;
}

PlaceMisfit place_misfit(const MovedBeads& beads) {
  const Surroundings surroundings = surroundings_of(beads);
  PlaceMisfit misfit;
  const auto mean = mean_member(beads);
  for (std::size_t k = 0; k < mean.size(); ++k) misfit.difference.push_back(beads.measured[k] - mean[k]);
  misfit.value = values_of(surroundings, misfit.difference);
  std::vector<double> maxima;
  for (const auto& difference : null_differences(beads, kDraws)) {
    const auto values = values_of(surroundings, difference);
    maxima.push_back(*std::max_element(values.begin(), values.end()));
  }
  misfit.threshold = std::max(kThresholds.least_misfit, exceeded_by(maxima, kThresholds.false_places));
  return misfit;
}

double exceeded_by(const std::vector<double>& maxima, double probability) {
  const double count = static_cast<double>(maxima.size());
  double mean = 0.0, square = 0.0;
  for (double one : maxima) mean += one / count;
  for (double one : maxima) square += (one - mean) * (one - mean) / (count - 1.0);
  const double scale = std::sqrt(6.0 * square) / std::numbers::pi;
  return mean - scale * (std::numbers::egamma + std::log(-std::log1p(-probability)));
}

}  // namespace pendular::diagnosis
