#include "tracking/registration.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "base/random.h"
#include "packing/bridges.h"
#include "tracking/constellation.h"
#include "tracking/following.h"

namespace pendular::tracking {
namespace {

constexpr std::size_t kStarts = 40;
constexpr std::uint64_t kOrder = 1;  // of the beads that it starts from: the same in every run
constexpr double kGrowth = 0.25, kTornGrowth = 0.4, kDeparture = 0.5;  // mean diameters
constexpr double kLeastFilled = 0.6, kLeastFilledOfFew = 1.2;
constexpr double kLeastShare = 0.3;  // of the smaller scan that a match must reach
constexpr std::size_t kLeastMatches = 8;

/// Whether a match has no more holes than a right one. Of the places that it leads to, a wrong one fills
/// some two fifths by chance; among few places chance reaches farther.
bool is_filled(const Following& following, const Partners& partners) {
  double led = 0.0, matched = 0.0;
  for (std::size_t k = 0; k < partners.size(); ++k)
    if (following.led_to(partners, k)) led += 1.0, matched += partners[k] >= 0;
  return led > 0.0 && matched / led >= kLeastFilled + kLeastFilledOfFew / std::sqrt(led);
}

/// The match that grows from an anchor; empty where it has holes as a wrong one, or does not reach far.
std::vector<BeadMatch> grown(const std::vector<Bead>& before, const std::vector<Bead>& after,
                             const Anchor& anchor) {
  Similarity rough;
  rough.rotation = anchor.rotation;
  rough.scale = mean_diameter(after) / mean_diameter(before);
  rough.shift = after[static_cast<std::size_t>(anchor.after)].centre -
                rough.scale * (rough.rotation * before[static_cast<std::size_t>(anchor.before)].centre);
  const auto turned = registered(after, rough);
  const Following following(before, turned);
  Partners partners(before.size(), -1);
  for (const auto& [a, b] : anchor.pairs) partners[static_cast<std::size_t>(a)] = b;
  while (following.extend(partners, kGrowth, false) > 0) {
  }
  if (!is_filled(following, partners)) return {};
  while (following.extend(partners, kTornGrowth, false) > 0) {
  }
  following.drop_departures(partners, kDeparture);
  std::vector<BeadMatch> matches;
  for (std::size_t k = 0; k < partners.size(); ++k)
    if (partners[k] >= 0) matches.push_back({static_cast<int>(k), partners[k], 0.0});
  const double least = kLeastShare * static_cast<double>(std::min(before.size(), after.size()));
  if (matches.size() < kLeastMatches || static_cast<double>(matches.size()) < least) matches.clear();
  return matches;
}

/// Matches of most beads, by trying some of the first scan one after the other.
std::vector<BeadMatch> found_again(const std::vector<Bead>& before, const std::vector<Bead>& after,
                                   const char* what) {
  std::vector<int> order(before.size());
  std::iota(order.begin(), order.end(), 0);
  const auto place = [](int k) { return random_bits(kOrder, static_cast<std::uint64_t>(k)); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return place(a) < place(b); });
  const Constellations constellations(before, after);
  const std::size_t starts = std::min(kStarts, order.size());
  Progress progress(what, static_cast<double>(starts));
  for (std::size_t n = 0; n < starts; ++n) {
    stop_if_interrupted();
    progress.update(static_cast<double>(n));
    const auto anchor = constellations.find(order[n]);
    if (!anchor) continue;
    if (auto matches = grown(before, after, *anchor); !matches.empty()) return matches;
  }
  return {};
}

}  // namespace

Registration register_scans(const std::vector<Bead>& before, const std::vector<Bead>& after,
                            std::optional<double> strain) {
  if (before.empty() || after.empty()) bad_input("no beads in one of both scans, expected some in each");
  const auto matches = found_again(before, after, "registration");
  if (!matches.empty()) return registration_of(before, after, matches, strain);
  std::vector<Bead> mirrored = after;
  for (auto& bead : mirrored) bead.centre.x() = -bead.centre.x();
  if (const auto reversed = found_again(before, mirrored, "registration in a mirror"); !reversed.empty())
    bad_input(
        "the constellation matches mirrored ({} of {} beads), expected a rotation (slices in reverse order, "
        "or one axis flipped?)",
        reversed.size(), before.size());
  bad_input("none of {} beads' surroundings are found again, expected another scan of the same specimen",
            std::min(kStarts, before.size()));
}

}  // namespace pendular::tracking
