#include "packing/touching.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "packing/bridges.h"

namespace pendular {
namespace {

constexpr double kNear = 3.0, kFar = 6.0;  // standard errors between which pairs are taken to be apart
constexpr int kRounds = 4, kSweeps = 400;
constexpr double kClosed = 1e-3;  // of a standard error

/// Share of pairs truly apart that are measured to overlap: ∫ Φ(−u) du from zero.
const double kSeenOverlapping = 1.0 / std::sqrt(2.0 * M_PI);

double largest_sigma(const std::vector<Bead>& beads) {
  double centre = 0.0, diameter = 0.0;
  for (const auto& bead : beads) {
    centre = std::max(centre, bead.sigma_centre);
    diameter = std::max(diameter, bead.sigma_diameter);
  }
  return std::sqrt(2.0 * centre * centre + 0.5 * diameter * diameter);
}

/// Moves two beads until they touch, each by its share of the gap's variance. Returns what was off, in
/// standard errors.
double close(Bead& a, Bead& b, double sigma_gap) {
  const double off = gap(a, b), step = off / (sigma_gap * sigma_gap);
  const Vec3 n = (a.centre - b.centre).normalized();
  a.centre -= step * a.sigma_centre * a.sigma_centre * n;
  b.centre += step * b.sigma_centre * b.sigma_centre * n;
  a.diameter += 0.5 * step * a.sigma_diameter * a.sigma_diameter;
  b.diameter += 0.5 * step * b.sigma_diameter * b.sigma_diameter;
  return std::fabs(off) / sigma_gap;
}

}  // namespace

bool TouchLikelihood::touches(double gap, double sigma) const {
  if (gap <= 0.0) return true;
  if (!(sigma > 0.0)) return false;
  const double u = gap / sigma;
  const double touch = touching * std::exp(-0.5 * u * u) / std::sqrt(2.0 * M_PI);
  const double apart = apart_per_sigma * 0.5 * std::erfc(-u / std::sqrt(2.0));
  return touch > apart;
}

TouchLikelihood touch_likelihood(const std::vector<Bead>& beads) {
  const double sigma = largest_sigma(beads);
  if (!(sigma > 0.0)) return {};
  double overlapping = 0.0, far = 0.0;
  for (const auto& pair : candidate_bridges(beads, kFar * sigma)) {
    if (!(pair.sigma_gap > 0.0)) continue;
    const double u = pair.gap / pair.sigma_gap;
    overlapping += u < 0.0;
    far += u >= kNear && u < kFar;
  }
  TouchLikelihood found;
  found.apart_per_sigma = far / (kFar - kNear);
  found.touching = std::max(0.0, 2.0 * (overlapping - kSeenOverlapping * found.apart_per_sigma));
  return found;
}

std::vector<Bead> closed_contacts(std::vector<Bead> beads) {
  const double sigma = largest_sigma(beads);
  if (!(sigma > 0.0)) return beads;
  const TouchLikelihood likelihood = touch_likelihood(beads);
  // By the gaps as they were measured; later rounds add only beads that have come to overlap.
  std::vector<Bridge> touching = candidate_bridges(beads, kFar * sigma);
  std::erase_if(touching, [&](const Bridge& pair) { return !likelihood.touches(pair.gap, pair.sigma_gap); });
  std::set<std::pair<int, int>> known;
  for (int round = 0; round < kRounds; ++round) {
    std::erase_if(touching, [](const Bridge& pair) { return !(pair.sigma_gap > 0.0); });
    for (const auto& pair : touching) known.emplace(pair.i, pair.j);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double worst = 0.0;
      for (const auto& pair : touching)
        worst = std::max(worst, close(beads[pair.i], beads[pair.j], pair.sigma_gap));
      if (worst < kClosed) break;
    }
    std::vector<Bridge> more = candidate_bridges(beads, -kClosed * sigma);
    std::erase_if(more, [&](const Bridge& pair) { return known.contains({pair.i, pair.j}); });
    if (more.empty()) break;
    touching.insert(touching.end(), more.begin(), more.end());
  }
  return beads;
}

}  // namespace pendular
