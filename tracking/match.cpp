#include "tracking/match.h"

#include <algorithm>
#include <map>

#include "base/parallel.h"
#include "tracking/following.h"

namespace pendular::tracking {
namespace {

// Lengths in mean diameters.
constexpr double kConstellation = 1.0;  // gap within which neighbours belong to it
constexpr double kFound = 0.25;         // how far a neighbour may be from its place
constexpr double kLeastScore = 0.5, kLeastLead = 0.15;
constexpr double kFollowed = 0.4;   // how far a bead may be from where its neighbours lead
constexpr double kLoose = 1.0;      // likewise, of one that has come loose
constexpr double kDeparture = 0.5;  // from the motion of neighbours, beyond which a match is wrong
constexpr std::size_t kLeastNeighbours = 5;
constexpr int kRounds = 12;

class Matcher {
 public:
  Matcher(const std::vector<Bead>& before, const std::vector<Bead>& after, const Eigen::Affine3d& even,
          double reach)
      : before_(before),
        after_(after),
        even_(even),
        following_(before, after),
        reach_(reach * following_.diameter()),
        partner_(before.size(), -1),
        score_(before.size(), 0.0),
        neighbours_(neighbours_within(before, kConstellation * following_.diameter())) {}

  std::vector<BeadMatch> match() {
    for_blocks(before_.size(), 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) by_constellation(k);
    });
    drop_claimed_twice();
    following_.drop_departures(partner_, kDeparture);
    for (int round = 0; round < kRounds && following_.extend(partner_, kFollowed, false) > 0; ++round) {
    }
    for (int round = 0; round < kRounds && following_.extend(partner_, kLoose, true) > 0; ++round) {
    }
    std::vector<BeadMatch> matches;
    for (std::size_t k = 0; k < before_.size(); ++k)
      if (partner_[k] >= 0)
        matches.push_back({static_cast<int>(k), partner_[k],
                           score(k, after_[static_cast<std::size_t>(partner_[k])].centre)});
    return matches;
  }

 private:
  /// The share of a bead's neighbours that are found about a place it may have moved to.
  double score(std::size_t k, const Vec3& moved) const {
    const auto& all = neighbours_[k];
    if (all.size() < kLeastNeighbours) return 0.0;
    double found = 0.0;
    for (const int other : all) {
      const Bead& neighbour = before_[static_cast<std::size_t>(other)];
      const Vec3 at = moved + even_.linear() * (neighbour.centre - before_[k].centre);
      bool there = false;
      following_.grid_after().near(at, kFound * following_.diameter(), [&](int candidate, double) {
        there = there || alike(neighbour, after_[static_cast<std::size_t>(candidate)], following_.diameter());
      });
      found += there;
    }
    return found / static_cast<double>(all.size());
  }

  void by_constellation(std::size_t k) {
    double best = 0.0, second = 0.0;
    int partner = -1;
    following_.grid_after().near(even_ * before_[k].centre, reach_, [&](int candidate, double) {
      const Bead& moved = after_[static_cast<std::size_t>(candidate)];
      if (!alike(before_[k], moved, following_.diameter())) return;
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

  const std::vector<Bead>&before_, &after_;
  const Eigen::Affine3d even_;
  Following following_;
  double reach_;
  Partners partner_;
  std::vector<double> score_;
  std::vector<std::vector<int>> neighbours_;
};

}  // namespace

std::vector<BeadMatch> match_beads(const std::vector<Bead>& before, const std::vector<Bead>& after,
                                   const Eigen::Affine3d& even, const MatchOptions& options) {
  return Matcher(before, after, even, options.reach).match();
}

}  // namespace pendular::tracking
