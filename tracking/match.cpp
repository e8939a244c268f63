#include "tracking/match.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "packing/bridges.h"
#include "packing/neighbours.h"

namespace pendular {
namespace {

// Lengths in mean diameters.
constexpr double kConstellation = 1.0;  // gap within which neighbours belong to it
constexpr double kFound = 0.25;         // how far a neighbour may be from its place
constexpr double kLeastScore = 0.5, kLeastLead = 0.15;
constexpr double kFollowed = 0.4;      // how far a bead may be from where its neighbours lead
constexpr double kLoose = 1.0;         // likewise, of one that has come loose
constexpr double kDeparture = 0.5;     // from the motion of neighbours, beyond which a match is wrong
constexpr double kSurroundings = 1.5;  // gap within which neighbours say how a bead moves
constexpr std::size_t kLeastNeighbours = 5;
constexpr int kRounds = 12;
constexpr double kSigmas = 5.0, kOwnDiameter = 2e-3;  // of diameters that may be one bead's
constexpr double kLeastShare = 0.1;

/// Beads by cells of one mean diameter.
class Cells {
 public:
  Cells(const std::vector<Bead>& beads, double edge) : beads_(beads), edge_(edge) {
    for (std::size_t k = 0; k < beads.size(); ++k)
      cells_[key(beads[k].centre)].push_back(static_cast<int>(k));
  }

  /// Calls f(bead, distance) for every bead within `reach` of a place.
  template <typename Function>
  void near(const Vec3& place, double reach, const Function& f) const {
    const auto low = key(place - Vec3::Constant(reach)), high = key(place + Vec3::Constant(reach));
    for (long x = low[0]; x <= high[0]; ++x)
      for (long y = low[1]; y <= high[1]; ++y)
        for (long z = low[2]; z <= high[2]; ++z) {
          const auto found = cells_.find({x, y, z});
          if (found == cells_.end()) continue;
          for (const int k : found->second)
            if (const double d = (beads_[static_cast<std::size_t>(k)].centre - place).norm(); d <= reach)
              f(k, d);
        }
  }

 private:
  using Key = std::array<long, 3>;
  Key key(const Vec3& p) const {
    return {static_cast<long>(std::floor(p.x() / edge_)), static_cast<long>(std::floor(p.y() / edge_)),
            static_cast<long>(std::floor(p.z() / edge_))};
  }
  const std::vector<Bead>& beads_;
  double edge_;
  std::map<Key, std::vector<int>> cells_;
};

/// The even compression that brings the extent of one scan's centres onto the other's: 1st to 99th percentile
/// along each axis.
struct EvenMotion {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero(), scale = Vec3::Ones();

  EvenMotion(const std::vector<Bead>& before, const std::vector<Bead>& after) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = extent(before, axis);
      const auto [low_after, high_after] = extent(after, axis);
      scale[axis] = high > low ? (high_after - low_after) / (high - low) : 1.0;
      from[axis] = 0.5 * (low + high), to[axis] = 0.5 * (low_after + high_after);
    }
  }
  Vec3 operator()(const Vec3& p) const { return to + scale.cwiseProduct(p - from); }

 private:
  static std::pair<double, double> extent(const std::vector<Bead>& beads, int axis) {
    std::vector<double> places;
    for (const auto& bead : beads) places.push_back(bead.centre[axis]);
    std::sort(places.begin(), places.end());
    const auto at = [&](double share) {
      return places[static_cast<std::size_t>(share * static_cast<double>(places.size() - 1))];
    };
    return {at(0.01), at(0.99)};
  }
};

class Matcher {
 public:
  Matcher(const std::vector<Bead>& before, const std::vector<Bead>& after, double reach)
      : before_(before),
        after_(after),
        diameter_(mean_diameter(before)),
        reach_(reach * diameter_),
        even_(before, after),
        cells_(after, diameter_),
        partner_(before.size(), -1),
        score_(before.size(), 0.0),
        neighbours_(neighbours(kConstellation)),
        surroundings_(neighbours(kSurroundings)) {}

  std::vector<BeadMatch> match() {
    for_blocks(before_.size(), 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) by_constellation(k);
    });
    drop_claimed_twice();
    drop_departures();
    for (int round = 0; round < kRounds && follow_neighbours(kFollowed, false) > 0; ++round) {
    }
    for (int round = 0; round < kRounds && follow_neighbours(kLoose, true) > 0; ++round) {
    }
    std::vector<BeadMatch> matches;
    for (std::size_t k = 0; k < before_.size(); ++k)
      if (partner_[k] >= 0)
        matches.push_back({static_cast<int>(k), partner_[k], score(k, after_[place(k)].centre)});
    return matches;
  }

 private:
  std::size_t place(std::size_t k) const { return static_cast<std::size_t>(partner_[k]); }

  std::vector<std::vector<int>> neighbours(double gap) const {
    std::vector<std::vector<int>> found(before_.size());
    for (const auto& [i, j] : pairs_within(centres_of(before_), diameters_of(before_), gap * diameter_)) {
      found[static_cast<std::size_t>(i)].push_back(j);
      found[static_cast<std::size_t>(j)].push_back(i);
    }
    return found;
  }

  bool alike(const Bead& a, const Bead& b) const {
    const double sigma = std::hypot(a.sigma_diameter, b.sigma_diameter);
    return std::fabs(a.diameter - b.diameter) < kSigmas * sigma + kOwnDiameter * diameter_ ||
           sigma == 0.0;  // nothing is stated: diameters tell nothing
  }

  /// The share of a bead's neighbours that are found about a place it may have moved to.
  double score(std::size_t k, const Vec3& moved) const {
    const auto& all = neighbours_[k];
    if (all.size() < kLeastNeighbours) return 0.0;
    double found = 0.0;
    for (const int other : all) {
      const Bead& neighbour = before_[static_cast<std::size_t>(other)];
      // The even compression says how a constellation as a whole is deformed.
      const Vec3 at = moved + even_.scale.cwiseProduct(neighbour.centre - before_[k].centre);
      bool there = false;
      cells_.near(at, kFound * diameter_, [&](int candidate, double) {
        there = there || alike(neighbour, after_[static_cast<std::size_t>(candidate)]);
      });
      found += there;
    }
    return found / static_cast<double>(all.size());
  }

  void by_constellation(std::size_t k) {
    double best = 0.0, second = 0.0;
    int partner = -1;
    cells_.near(even_(before_[k].centre), reach_, [&](int candidate, double) {
      const Bead& moved = after_[static_cast<std::size_t>(candidate)];
      if (!alike(before_[k], moved)) return;
      const double found = score(k, moved.centre);
      if (found > best)
        second = best, best = found, partner = candidate;
      else
        second = std::max(second, found);
    });
    if (best < kLeastScore || best - second < kLeastLead) return;
    partner_[k] = partner, score_[k] = best;
  }

  void drop_claimed_twice() {
    std::map<int, std::size_t> owner;
    for (std::size_t k = 0; k < before_.size(); ++k) {
      if (partner_[k] < 0) continue;
      const auto [claimed, first] = owner.try_emplace(partner_[k], k);
      if (first) continue;
      const bool better = score_[k] > score_[claimed->second];
      partner_[better ? claimed->second : k] = -1;
      if (better) claimed->second = k;
    }
  }

  /// Where the motion of matched neighbours, extended linearly, brings a bead; nothing where too few are.
  std::optional<Vec3> led_to(std::size_t k) const {
    std::vector<int> matched;
    for (const int other : surroundings_[k])
      if (partner_[static_cast<std::size_t>(other)] >= 0) matched.push_back(other);
    if (matched.size() < kLeastNeighbours) return std::nullopt;
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
    for (const int other : matched) {
      const auto n = static_cast<std::size_t>(other);
      const Vec3 from = (before_[n].centre - before_[k].centre) / diameter_;
      const Eigen::Vector4d row(1.0, from.x(), from.y(), from.z());
      matrix += row * row.transpose();
      right += row * (after_[place(n)].centre - before_[n].centre).transpose();
    }
    // Gradients that few neighbours leave open stay small.
    matrix.diagonal().tail<3>().array() += 0.5;
    return before_[k].centre + Vec3(matrix.ldlt().solve(right).row(0).transpose());
  }

  void drop_departures() {
    for (int round = 0; round < 3; ++round) {
      std::vector<std::size_t> wrong;
      for (std::size_t k = 0; k < before_.size(); ++k) {
        if (partner_[k] < 0) continue;
        const auto expected = led_to(k);
        if (!expected || (after_[place(k)].centre - *expected).norm() > kDeparture * diameter_)
          wrong.push_back(k);
      }
      for (const std::size_t k : wrong) partner_[k] = -1;
      if (wrong.empty()) return;
    }
  }

  /// Matches beads next to matched ones, to what is left within `reach` diameters of where these lead; how
  /// many more there are. `only`: where no other bead that is left could be meant.
  std::size_t follow_neighbours(double reach, bool only) {
    std::vector<bool> taken(after_.size(), false);
    for (const int partner : partner_)
      if (partner >= 0) taken[static_cast<std::size_t>(partner)] = true;
    struct Claim {
      double distance;
      std::size_t bead;
      int partner;
    };
    std::vector<Claim> claims;
    for (std::size_t k = 0; k < before_.size(); ++k) {
      if (partner_[k] >= 0) continue;
      const auto expected = led_to(k);
      if (!expected) continue;
      cells_.near(*expected, reach * diameter_, [&](int candidate, double distance) {
        if (!taken[static_cast<std::size_t>(candidate)] &&
            alike(before_[k], after_[static_cast<std::size_t>(candidate)]))
          claims.push_back({distance, k, candidate});
      });
    }
    std::sort(claims.begin(), claims.end(), [](const Claim& a, const Claim& b) {
      return std::tie(a.distance, a.bead, a.partner) < std::tie(b.distance, b.bead, b.partner);
    });
    std::map<std::size_t, int> choices;
    std::map<int, int> claimants;
    for (const auto& claim : claims) ++choices[claim.bead], ++claimants[claim.partner];
    std::size_t more = 0;
    for (const auto& claim : claims) {
      if (only && (choices[claim.bead] > 1 || claimants[claim.partner] > 1)) continue;
      if (partner_[claim.bead] >= 0 || taken[static_cast<std::size_t>(claim.partner)]) continue;
      partner_[claim.bead] = claim.partner, taken[static_cast<std::size_t>(claim.partner)] = true, ++more;
    }
    return more;
  }

  const std::vector<Bead>&before_, &after_;
  double diameter_, reach_;
  EvenMotion even_;
  Cells cells_;
  std::vector<int> partner_;
  std::vector<double> score_;
  std::vector<std::vector<int>> neighbours_, surroundings_;
};

}  // namespace

std::vector<BeadMatch> match_beads(const std::vector<Bead>& before, const std::vector<Bead>& after,
                                   const MatchOptions& options) {
  if (before.empty() || after.empty()) bad_input("no beads in one of both scans, expected some in each");
  const auto matches = Matcher(before, after, options.reach).match();
  if (static_cast<double>(matches.size()) < kLeastShare * static_cast<double>(before.size()))
    bad_input(
        "{} of {} beads were found again, expected most of them (another specimen, or turned or shifted by "
        "more "
        "than {} diameters between the scans?)",
        matches.size(), before.size(), options.reach);
  return matches;
}

}  // namespace pendular
