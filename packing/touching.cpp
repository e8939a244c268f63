#include "packing/touching.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "packing/bridges.h"

namespace pendular {
namespace {

constexpr double kNear = 3.0, kFar = 6.0;  // standard errors between which pairs are taken to be apart
constexpr int kRounds = 40, kSweeps = 3000;
constexpr double kClosed = 1e-3;          // of a standard error
constexpr double kCountsAsClosed = 1e-2;  // of a standard error: later closures have moved the pair a little
constexpr double kRounding = 1e-9;        // of a diameter
constexpr std::size_t kLeastOnPlane = 5;  // beads

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

/// Two beads that do not overlap, and touch where they are closed.
struct Contact {
  Bridge pair;
  bool closed = false;
  double push = 0.0;  ///< by which they have been moved apart, as a multiplier of the gap
};

/// Moves two beads until they touch, each by its share of the gap's variance; those that are not closed come
/// no nearer than they would be had they not been moved apart. Returns by how much, in standard errors.
double meet(Contact& contact, std::vector<Bead>& beads) {
  Bead &a = beads[contact.pair.i], &b = beads[contact.pair.j];
  const double sigma = contact.pair.sigma_gap;
  double step = gap(a, b) / (sigma * sigma);
  if (!contact.closed) step = std::min(step, contact.push);
  if (step == 0.0) return 0.0;
  contact.push -= step;
  const Vec3 n = (a.centre - b.centre).normalized();
  a.centre -= step * a.sigma_centre * a.sigma_centre * n;
  b.centre += step * b.sigma_centre * b.sigma_centre * n;
  a.diameter += 0.5 * step * a.sigma_diameter * a.sigma_diameter;
  b.diameter += 0.5 * step * b.sigma_diameter * b.sigma_diameter;
  return std::fabs(step) * sigma;
}

/// One flat end of a specimen: height counts from outside, along `way` (1: from below, −1: from above).
struct End {
  double way = 1.0, height = 0.0;
  std::vector<std::size_t> touching;

  double of(const Bead& bead) const { return way * bead.centre.z() - 0.5 * bead.diameter; }
};

double sigma_of_end(const Bead& bead) {
  return std::hypot(bead.sigma_centre, 0.5 * bead.sigma_diameter);
}

/// Moves a bead until it touches the end. Returns what was off, in standard errors.
double close(Bead& bead, const End& end) {
  const double sigma = sigma_of_end(bead), off = end.of(bead) - end.height, step = off / (sigma * sigma);
  bead.centre.z() -= end.way * step * bead.sigma_centre * bead.sigma_centre;
  bead.diameter += 0.5 * step * bead.sigma_diameter * bead.sigma_diameter;
  return std::fabs(off) / sigma;
}

double gap_in_sigmas(const Bridge& pair, const std::vector<Bead>& beads) {
  return gap(beads[pair.i], beads[pair.j]) / pair.sigma_gap;
}

/// Adds pairs, nearer than some gap, that are not known yet. Returns whether there are any.
bool add_nearer(double than, const std::vector<Bead>& beads, std::vector<Contact>& contacts) {
  std::set<std::pair<int, int>> known;
  for (const auto& contact : contacts) known.emplace(contact.pair.i, contact.pair.j);
  for (const auto& pair : candidate_bridges(beads, than))
    if (pair.sigma_gap > 0.0 && !known.contains({pair.i, pair.j})) contacts.push_back({pair});
  return contacts.size() > known.size();
}

/// The least moves, in units of standard errors, after which no pair overlaps and what is closed touches.
/// Where errors are larger than stated, pairs that were far apart may come to overlap: they are added.
void settle(double sigma, const std::vector<End>& ends, std::vector<Contact>& contacts,
            std::vector<Bead>& beads) {
  for (int round = 0; round < kRounds; ++round) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double worst = 0.0;
      for (auto& contact : contacts) worst = std::max(worst, meet(contact, beads));
      for (const auto& end : ends)
        for (const std::size_t k : end.touching) worst = std::max(worst, close(beads[k], end));
      if (worst < kClosed) break;
    }
    if (!add_nearer(-kClosed * sigma, beads, contacts)) return;
  }
}

/// Counts of beads at an end at some height, by how far they are from it in standard errors.
TouchLikelihood likelihood_at(const End& end, const std::vector<Bead>& beads) {
  TouchLikelihood found;
  double far = 0.0;
  for (const auto& bead : beads) {
    const double u = (end.of(bead) - end.height) / sigma_of_end(bead);
    found.touching += u < kNear;
    far += u >= kNear && u < kFar;
  }
  found.apart_per_sigma = far / (kFar - kNear);
  found.touching = std::max(0.0, found.touching - (kNear + kSeenOverlapping) * found.apart_per_sigma);
  return found;
}

/// The plane on which the outermost beads lie, as their mean: of those that likely touch it. None touch where
/// the end is not flat.
End flat_end(const std::vector<Bead>& beads, double way) {
  End end{way, 0.0, {}};
  std::vector<double> heights;
  for (const auto& bead : beads) heights.push_back(end.of(bead));
  std::sort(heights.begin(), heights.end());
  end.height = heights[std::min(heights.size() - 1, kLeastOnPlane)];
  for (int round = 0; round < kRounds; ++round) {
    const TouchLikelihood likelihood = likelihood_at(end, beads);
    end.touching.clear();
    double sum = 0.0;
    for (std::size_t k = 0; k < beads.size(); ++k) {
      const double off = end.of(beads[k]) - end.height, sigma = sigma_of_end(beads[k]);
      if (!(sigma > 0.0) || off > kNear * sigma || !likelihood.touches(std::fabs(off), sigma)) continue;
      end.touching.push_back(k), sum += off;
    }
    if (end.touching.size() < kLeastOnPlane) return {way, 0.0, {}};
    end.height += sum / static_cast<double>(end.touching.size());
  }
  return end;
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
  const std::vector<End> ends = {flat_end(beads, 1.0), flat_end(beads, -1.0)};
  const double touching = touch_likelihood(beads).touching;
  std::vector<Contact> contacts;
  add_nearer(kFar * sigma, beads, contacts);
  settle(sigma, ends, contacts, beads);
  // Of pairs that may touch the nearest do, as many as are estimated.
  std::stable_sort(contacts.begin(), contacts.end(), [&](const Contact& a, const Contact& b) {
    return gap_in_sigmas(a.pair, beads) < gap_in_sigmas(b.pair, beads);
  });
  const auto count = static_cast<std::size_t>(std::lround(touching));
  for (std::size_t k = 0; k < std::min(count, contacts.size()); ++k) contacts[k].closed = true;
  settle(sigma, ends, contacts, beads);
  return beads;
}

bool touches(const Bridge& pair, double diameter) {
  return pair.gap < std::max(kRounding * diameter, kCountsAsClosed * pair.sigma_gap);
}

std::size_t touching_pairs(const std::vector<Bead>& beads) {
  const double diameter = mean_diameter(beads);
  const auto near =
      candidate_bridges(beads, std::max(kRounding * diameter, kCountsAsClosed * largest_sigma(beads)));
  return static_cast<std::size_t>(
      std::count_if(near.begin(), near.end(), [&](const Bridge& pair) { return touches(pair, diameter); }));
}

}  // namespace pendular
