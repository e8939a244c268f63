#include "dem_core/step/listed.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/parallel.h"
#include "packing/neighbours.h"

namespace pendular::dem_core {
namespace {

constexpr std::size_t kPairsPerTask = 2048;
constexpr double kOfMargin = 0.999;  // displacements over margins are rounded

/// Every third bit of the result, from bit 0 up, is one of the 21 of `cell`.
std::uint64_t spread_bits(std::uint64_t cell) {
  std::uint64_t bits = cell & 0x1fffff;
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

/// Place on a curve that keeps neighbours in space close (Morton's order): the share of the specimen's extent
/// along each axis, so that half of the curve is half of the specimen, cut through by a plane.
std::uint64_t place_on_curve(const Vec3& share) {
  std::uint64_t place = 0;
  for (int axis = 0; axis < 3; ++axis)
    place |= spread_bits(static_cast<std::uint64_t>(share[axis] * 0x1fffff)) << axis;
  return place;
}

}  // namespace

std::vector<std::size_t> beads_in_space(const Simulation& simulation) {
  const auto& at = simulation.listing.at;
  Vec3 low = at.front(), high = at.front();
  for (const auto& x : at) low = low.cwiseMin(x), high = high.cwiseMax(x);
  const Vec3 extent = (high - low).cwiseMax(simulation.beads.radius.front());
  std::vector<std::pair<std::uint64_t, std::size_t>> place(at.size());
  for (std::size_t k = 0; k < at.size(); ++k)
    place[k] = {place_on_curve((at[k] - low).cwiseQuotient(extent)), k};
  std::sort(place.begin(), place.end());
  std::vector<std::size_t> order;
  for (const auto& [on_curve, k] : place) order.push_back(k);
  return order;
}

std::vector<char> touchable(const Simulation& simulation) {
  const auto& [at, margin, bottom_at, top_at, platen_margin] = simulation.listing;
  const auto& radius = simulation.beads.radius;
  const auto& pairs = simulation.pairs;
  // With one spring the contact's part of the law is in every pair.
  std::vector<char> found(pairs.size(), 1);
  if (simulation.law.one_spring) return found;
  for_blocks(pairs.size(), kPairsPerTask, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const int i = pairs[p].i, j = pairs[p].j;
      const double listed_gap = (at[i] - at[j]).norm() - radius[i] - radius[j];
      found[p] = listed_gap - pairs[p].properties.touch <= margin[i] + margin[j];
    }
  });
  return found;
}

Pair* find_pair(Simulation& simulation, int i, int j) {
  const auto before = [](const Pair& pair, const IndexPair& beads) {
    return IndexPair(pair.i, pair.j) < beads;
  };
  auto& pairs = simulation.pairs;
  const auto found = std::lower_bound(pairs.begin(), pairs.end(), IndexPair(i, j), before);
  return found != pairs.end() && found->i == i && found->j == j ? &*found : nullptr;
}

NearPlatens near_platens(const Simulation& simulation, std::size_t k) {
  const Listing& listing = simulation.listing;
  const double z = listing.at[k].z();
  const double reach = simulation.beads.radius[k] + listing.margin[k] + listing.platen_margin;
  return {z - reach + simulation.bottom.relief[k] <= listing.bottom_at,
          z + reach - simulation.top.relief[k] >= listing.top_at};
}

bool listing_due(const Simulation& simulation, double farthest) {
  if (farthest > kOfMargin * kOfMargin) return true;
  const Listing& listing = simulation.listing;
  return std::max(std::fabs(simulation.bottom.z - listing.bottom_at),
                  std::fabs(simulation.top.z - listing.top_at)) > listing.platen_margin;
}

void put_pair(const Pair& pair, const PairPlace& to, std::size_t at) {
  const PairProperties& own = pair.properties;
  const PairHistory& history = pair.history;
  PairColumns& columns = *to.columns;
  columns.rest[at] = own.rest;
  columns.kn[at] = static_cast<float>(own.kn), columns.kt[at] = static_cast<float>(own.kt);
  columns.break_limit[at] = static_cast<float>(own.break_limit);
  columns.closing[at] = static_cast<float>(history.closing);
  columns.slip_x[at] = history.bond_slip.x, columns.slip_y[at] = history.bond_slip.y;
  columns.slip_z[at] = history.bond_slip.z;
  if (ContactBlock* contact = to.contact) {
    contact->touch[at] = own.touch;
    contact->slip_x[at] = history.contact_slip.x, contact->slip_y[at] = history.contact_slip.y;
    contact->slip_z[at] = history.contact_slip.z;
  }
  if (BendBlock* bend = to.bend) {
    bend->k_bend[at] = own.k_bend, bend->k_twist[at] = own.k_twist;
    bend->turn_x[at] = history.turn.x, bend->turn_y[at] = history.turn.y, bend->turn_z[at] = history.turn.z;
  }
}

// What a step leaves as a zero of either sign is +0: a displacement that was passed over is the same as one
// that was computed.
void get_pair(const PairPlace& from, std::size_t at, Pair& pair) {
  const auto vector = [at](const auto& x, const auto& y, const auto& z) {
    return Triple<double>{x[at] + 0.0, y[at] + 0.0, z[at] + 0.0};
  };
  PairHistory& history = pair.history;
  const PairColumns& columns = *from.columns;
  history.bond_slip = vector(columns.slip_x, columns.slip_y, columns.slip_z);
  history.closing = columns.closing[at] + 0.0;
  if (const ContactBlock* contact = from.contact)
    history.contact_slip = vector(contact->slip_x, contact->slip_y, contact->slip_z);
  if (const BendBlock* bend = from.bend) history.turn = vector(bend->turn_x, bend->turn_y, bend->turn_z);
}

void put_bead(const Platen& platen, std::size_t bead, PlatenColumns& to, std::size_t at) {
  to.relief[at] = platen.relief[bead];
  to.slip_x[at] = platen.slip[bead].x(), to.slip_y[at] = platen.slip[bead].y();
  to.closing[at] = platen.closing[bead];
}

void get_bead(const PlatenColumns& from, std::size_t at, std::size_t bead, Platen& platen) {
  platen.slip[bead] = {from.slip_x[at] + 0.0, from.slip_y[at] + 0.0, 0.0};
  platen.closing[bead] = from.closing[at] + 0.0;
}

}  // namespace pendular::dem_core
