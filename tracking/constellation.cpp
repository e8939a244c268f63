#include "tracking/constellation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "packing/bridges.h"
#include "packing/neighbours.h"
#include "tracking/rotation.h"
#include "tracking/surroundings.h"

namespace pendular::tracking {
namespace {

// Lengths in mean diameters.
constexpr double kNear = 1.5, kMiddle = 2.0, kWide = 2.5;
constexpr double kBeyond = 0.4;      // farther than kWide, where a strained neighbour may be
constexpr double kSide = 0.15;       // by which sides of triangles may differ
constexpr double kFound = 0.25;      // how far a neighbour may be from its place
constexpr double kNearShare = 0.55;  // of near neighbours found by a triangle's rotation, else it is dropped
constexpr double kLeastScore = 0.5;
constexpr std::size_t kLeastNear = 4, kLeastWide = 8;
constexpr double kStiffness = 0.5;  // keeps a map near its rotation where few neighbours determine it

/// Axes of a triangle's two sides: their bisector, what lies across it in their plane, its normal.
Eigen::Matrix3d axes(const Vec3& a, const Vec3& b) {
  Eigen::Matrix3d all;
  all.col(0) = (a.normalized() + b.normalized()).normalized();
  all.col(2) = a.cross(b).normalized();
  all.col(1) = all.col(2).cross(all.col(0));
  return all;
}

}  // namespace

Constellations::Constellations(const std::vector<Bead>& before, const std::vector<Bead>& after)
    : before_(before),
      diameter_(mean_diameter(before)),
      after_(after),
      first_(surroundings(before, diameter_)),
      second_(surroundings(after, diameter_)) {
  const double scale = diameter_ / mean_diameter(after);
  for (auto& bead : after_) bead.diameter *= scale, bead.sigma_diameter *= scale;
}

std::vector<Constellations::Surroundings> Constellations::surroundings(const std::vector<Bead>& beads,
                                                                       double diameter) {
  const auto centres = centres_of(beads);
  const std::vector<double> points(beads.size(), 0.0);
  std::vector<Surroundings> all(beads.size());
  for (const auto& [i, j] : pairs_within(centres, points, (kWide + kBeyond) * diameter)) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const Vec3 from = (centres[b] - centres[a]) / diameter;
    all[a].push_back({from, from.norm(), j});
    all[b].push_back({-from, from.norm(), i});
  }
  for (auto& one : all)
    std::sort(one.begin(), one.end(), [](const Neighbour& a, const Neighbour& b) {
      return std::pair(a.distance, a.bead) < std::pair(b.distance, b.bead);
    });
  return all;
}

std::optional<Constellations::Triangle> Constellations::triangle(const Surroundings& about) {
  std::optional<Triangle> best;
  double largest = 0.0;
  for (const auto& a : about)
    for (const auto& b : about) {
      if (a.distance > kNear || b.distance > kNear || &a >= &b) continue;
      // The nearest are strained the least, and right angles turn the least by an error.
      const double fitness = a.at.cross(b.at).norm() / std::pow(a.distance * b.distance, 2);
      if (fitness > largest) largest = fitness, best = Triangle{&a, &b, (a.at - b.at).norm()};
    }
  return best;
}

bool Constellations::alike(int before, int after) const {
  return tracking::alike(before_[static_cast<std::size_t>(before)], after_[static_cast<std::size_t>(after)],
                         diameter_);
}

std::vector<std::pair<int, int>> Constellations::found(const Surroundings& first, const Surroundings& second,
                                                       const Eigen::Matrix3d& map, double radius) const {
  // Pairs are places in the two lists.
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t k = 0; k < first.size() && first[k].distance <= radius; ++k) {
    const Vec3 place = map * first[k].at;
    const double distance = place.norm();
    auto candidate =
        std::lower_bound(second.begin(), second.end(), distance - kFound,
                         [](const Neighbour& neighbour, double d) { return neighbour.distance < d; });
    double nearest = kFound;
    int partner = -1;
    for (; candidate != second.end() && candidate->distance <= distance + kFound; ++candidate) {
      const double off = (candidate->at - place).norm();
      if (off > nearest || !alike(first[k].bead, candidate->bead)) continue;
      nearest = off, partner = static_cast<int>(candidate - second.begin());
    }
    if (partner >= 0) pairs.emplace_back(static_cast<int>(k), partner);
  }
  return pairs;
}

Anchor Constellations::refined(int before, int after, Eigen::Matrix3d map) const {
  const Surroundings &first = first_[static_cast<std::size_t>(before)],
                     &second = second_[static_cast<std::size_t>(after)];
  Anchor anchor{before, after, map, 0.0, {}};
  std::vector<std::pair<int, int>> pairs;
  for (const double radius : {kNear, kMiddle, kWide}) {
    pairs = found(first, second, map, radius);
    Eigen::Matrix3d mixed = kStiffness * nearest_rotation(map),
                    square = kStiffness * Eigen::Matrix3d::Identity();
    for (const auto& [i, j] : pairs) {
      const Vec3 &from = first[static_cast<std::size_t>(i)].at, &to = second[static_cast<std::size_t>(j)].at;
      mixed += to * from.transpose(), square += from * from.transpose();
    }
    map = mixed * square.inverse();
  }
  const auto all = std::count_if(first.begin(), first.end(),
                                 [](const Neighbour& neighbour) { return neighbour.distance <= kWide; });
  anchor.rotation = nearest_rotation(map);
  anchor.score = static_cast<double>(pairs.size()) / static_cast<double>(all);
  for (const auto& [i, j] : pairs)
    anchor.pairs.emplace_back(first[static_cast<std::size_t>(i)].bead,
                              second[static_cast<std::size_t>(j)].bead);
  anchor.pairs.emplace_back(before, after);
  return anchor;
}

Anchor Constellations::compare(int before, const Triangle& sides, int after) const {
  const Surroundings &first = first_[static_cast<std::size_t>(before)],
                     &second = second_[static_cast<std::size_t>(after)];
  const Eigen::Matrix3d own = axes(sides.first->at, sides.second->at);
  const auto near = static_cast<double>(
      std::count_if(first.begin(), first.end(), [](const Neighbour& n) { return n.distance <= kNear; }));
  const auto like = [&](const Neighbour& side, const Neighbour& other) {
    return std::fabs(side.distance - other.distance) <= kSide && alike(side.bead, other.bead);
  };
  Anchor best;
  for (const auto& a : second) {
    if (a.distance > sides.first->distance + kSide) break;
    if (!like(*sides.first, a)) continue;
    for (const auto& b : second) {
      if (b.distance > sides.second->distance + kSide) break;
      if (&a == &b || !like(*sides.second, b)) continue;
      if (std::fabs((a.at - b.at).norm() - sides.side) > kSide) continue;
      const Eigen::Matrix3d rotation = axes(a.at, b.at) * own.transpose();
      if (static_cast<double>(found(first, second, rotation, kNear).size()) < kNearShare * near) continue;
      if (Anchor anchor = refined(before, after, rotation); anchor.score > best.score)
        best = std::move(anchor);
    }
  }
  return best;
}

std::optional<Anchor> Constellations::find(int before) const {
  const Surroundings& about = first_[static_cast<std::size_t>(before)];
  const auto within = [&](double radius) {
    return static_cast<std::size_t>(
        std::count_if(about.begin(), about.end(),
                      [&](const Neighbour& neighbour) { return neighbour.distance <= radius; }));
  };
  const auto sides = triangle(about);
  if (!sides || within(kNear) < kLeastNear || within(kWide) < kLeastWide) return std::nullopt;
  std::vector<Anchor> best_of((after_.size() + 63) / 64);
  for_blocks(after_.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      if (!alike(before, static_cast<int>(k))) continue;
      Anchor anchor = compare(before, *sides, static_cast<int>(k));
      if (anchor.score > best_of[first / 64].score) best_of[first / 64] = std::move(anchor);
    }
  });
  Anchor best;
  for (auto& anchor : best_of)
    if (anchor.score > best.score) best = std::move(anchor);
  if (best.score < kLeastScore) return std::nullopt;
  return best;
}

}  // namespace pendular::tracking
