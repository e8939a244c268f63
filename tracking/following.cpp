#include "tracking/following.h"

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <tuple>

#include "base/parallel.h"
#include "packing/bridges.h"

namespace pendular::tracking {
namespace {

constexpr double kSurroundings = 1.5;  // gap within which neighbours say how a bead moves, mean diameters
constexpr std::size_t kLeastNeighbours = 5;
constexpr double kStiffness = 0.5;  // keeps gradients small that few neighbours leave open
constexpr int kDropRounds = 3;

struct Claim {
  double distance;
  std::size_t bead;
  int partner;
};

}  // namespace

Following::Following(const std::vector<Bead>& before, const std::vector<Bead>& after)
    : before_(before),
      after_(after),
      diameter_(mean_diameter(before)),
      grid_(after, diameter_),
      surroundings_(neighbours_within(before, kSurroundings * diameter_)) {}

std::optional<Vec3> Following::led_to(const Partners& partners, std::size_t bead,
                                      const std::vector<bool>& without) const {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
  std::size_t leading = 0;
  for (const int other : surroundings_[bead]) {
    const auto n = static_cast<std::size_t>(other);
    if (partners[n] < 0 || (!without.empty() && without[n])) continue;
    const Vec3 from = (before_[n].centre - before_[bead].centre) / diameter_;
    const Eigen::Vector4d row(1.0, from.x(), from.y(), from.z());
    matrix += row * row.transpose();
    right += row * (after_[static_cast<std::size_t>(partners[n])].centre - before_[n].centre).transpose();
    ++leading;
  }
  if (leading < kLeastNeighbours) return std::nullopt;
  matrix.diagonal().tail<3>().array() += kStiffness;
  return before_[bead].centre + Vec3(matrix.ldlt().solve(right).row(0).transpose());
}

std::size_t Following::extend(Partners& partners, double reach, bool only) const {
  std::vector<bool> taken(after_.size(), false);
  for (const int partner : partners)
    if (partner >= 0) taken[static_cast<std::size_t>(partner)] = true;
  std::vector<std::vector<Claim>> claims_of(before_.size());
  for_blocks(before_.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      if (partners[k] >= 0) continue;
      const auto expected = led_to(partners, k);
      if (!expected) continue;
      grid_.near(*expected, reach * diameter_, [&](int candidate, double distance) {
        const auto n = static_cast<std::size_t>(candidate);
        if (!taken[n] && alike(before_[k], after_[n], diameter_))
          claims_of[k].push_back({distance, k, candidate});
      });
    }
  });
  std::vector<Claim> claims;
  std::vector<int> claimants(after_.size(), 0);
  for (const auto& some : claims_of)
    for (const auto& claim : some)
      claims.push_back(claim), ++claimants[static_cast<std::size_t>(claim.partner)];
  std::sort(claims.begin(), claims.end(), [](const Claim& a, const Claim& b) {
    return std::tie(a.distance, a.bead, a.partner) < std::tie(b.distance, b.bead, b.partner);
  });
  std::size_t more = 0;
  for (const auto& claim : claims) {
    const auto n = static_cast<std::size_t>(claim.partner);
    if (only && (claims_of[claim.bead].size() > 1 || claimants[n] > 1)) continue;
    if (partners[claim.bead] >= 0 || taken[n]) continue;
    partners[claim.bead] = claim.partner, taken[n] = true, ++more;
  }
  return more;
}

void Following::drop_departures(Partners& partners, double reach) const {
  for (int round = 0; round < kDropRounds; ++round) {
    std::vector<std::size_t> wrong;
    for (std::size_t k = 0; k < before_.size(); ++k) {
      if (partners[k] < 0) continue;
      const auto expected = led_to(partners, k);
      const Vec3& moved = after_[static_cast<std::size_t>(partners[k])].centre;
      if (!expected || (moved - *expected).norm() > reach * diameter_) wrong.push_back(k);
    }
    for (const std::size_t k : wrong) partners[k] = -1;
    if (wrong.empty()) return;
  }
}

}  // namespace pendular::tracking
