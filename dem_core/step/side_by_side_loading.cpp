#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "dem_core/step/side_by_side.h"

namespace pendular::dem_core {
namespace {

constexpr double kMostPairs = 1.2;      // of all runs to those of one: what that costs takes the gain
constexpr std::size_t kOutOfOrder = 8;  // one pair in so many, and the tables are loaded anew

bool same_parts(const LawParameters& a, const LawParameters& b) {
  return a.one_spring == b.one_spring && a.bond_friction_limit == b.bond_friction_limit &&
         a.bending == b.bending && (a.hertz_overlap > 0.0) == (b.hertz_overlap > 0.0) &&
         a.separate_limits == b.separate_limits;
}

std::vector<IndexPair> pairs_of_all(std::span<Simulation* const> simulations) {
  std::vector<IndexPair> pairs;
  for (const Simulation* simulation : simulations)
    for (const Pair& pair : simulation->pairs) pairs.emplace_back(pair.i, pair.j);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Appends a pair; returns its place.
std::size_t append(SidePairs& pairs, SidePairs::Ends ends, PairKind kind, bool bending) {
  pairs.ends.push_back(ends);
  pairs.columns.push_back({});
  if (kind != PairKind::apart) pairs.contacts.push_back({}), pairs.apart.push_back(0);
  if (bending) pairs.bends.push_back({});
  return pairs.ends.size() - 1;
}

PairKind kind_of(const Pair& pair, bool may_touch) {
  return pair.bond < 0 ? PairKind::loose : may_touch ? PairKind::touchable : PairKind::apart;
}

/// Of a pair that has these kinds in two runs.
PairKind of_both(PairKind a, PairKind b) {
  if (a == b) return a;
  // Only bonds whose glass cannot touch in any run are apart; pairs not listed by a run cannot touch there.
  return PairKind::touchable;
}

}  // namespace

bool SideBySide::suits(std::span<Simulation* const> simulations) {
  if (simulations.size() < 2 || simulations.size() > kRuns) return false;
  const Simulation& first = *simulations.front();
  double pairs = 0.0;
  for (const Simulation* one : simulations) {
    if (one->beads.size() != first.beads.size() || !same_parts(one->law, first.law)) return false;
    pairs += static_cast<double>(one->pairs.size()) / static_cast<double>(simulations.size());
  }
  return static_cast<double>(pairs_of_all(simulations).size()) <= kMostPairs * pairs;
}

SideBySide::SideBySide(std::span<Simulation* const> simulations)
    : runs_(simulations.begin(), simulations.end()), parts_(parts(simulations.front()->law)) {
  for (const Simulation* simulation : runs_) quanta_.push_back(quanta(*simulation));
  load();
}

/// All tables anew, of the runs that go on.
void SideBySide::load() {
  const Simulation& first = **std::find_if(runs_.begin(), runs_.end(), [](const auto* s) { return s; });
  bead_of_ = beads_in_space(first);
  row_of_.resize(bead_of_.size());
  for (std::size_t row = 0; row < bead_of_.size(); ++row)
    row_of_[bead_of_[row]] = static_cast<std::uint32_t>(row);
  beads_.motion.assign(bead_of_.size() + 2, {});
  beads_.sums.assign(bead_of_.size() + 2, {});
  beads_.inertia.assign(bead_of_.size(), {});
  law_ = {};
  for (SidePlaten* platen : {&bottom_, &top_}) {
    platen->numbers = {};
    platen->beads.assign(bead_of_.size(), {});
  }
  std::fill_n(beads_.motion.back().x, kRuns, 1.0);
  // Lanes without a run hold beads that nothing moves.
  for (std::size_t run = 0; run < kRuns; ++run)
    if (run >= runs_.size() || !runs_[run]) load_beads(run, first);
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    if (!runs_[run]) continue;
    load_beads(run, *runs_[run]);
    load_law(run);
    load_platen(run, runs_[run]->bottom, bottom_), load_platen(run, runs_[run]->top, top_);
    load_listing(run);
  }
  load_places();
  find_beads_near_platens();
}

void SideBySide::load_beads(std::size_t run, const Simulation& from) {
  const bool goes_on = run < runs_.size() && runs_[run];
  for (std::size_t row = 0; row < bead_of_.size(); ++row) {
    const BeadMotion now = from.beads.motion(bead_of_[row]);
    SideBead& bead = beads_.motion[row];
    bead.x[run] = now.position.x(), bead.y[run] = now.position.y(), bead.z[run] = now.position.z();
    bead.radius[run] = now.radius;
    if (!goes_on) continue;
    bead.vx[run] = now.velocity.x(), bead.vy[run] = now.velocity.y(), bead.vz[run] = now.velocity.z();
    bead.wx[run] = now.spin.x(), bead.wy[run] = now.spin.y(), bead.wz[run] = now.spin.z();
  }
}

void SideBySide::load_law(std::size_t run) {
  const Simulation& simulation = *runs_[run];
  const auto [k_glass, kt_glass, per_overlap, friction, damping, dt, half_dt, half_damping_dt] =
      numbers(simulation.law, simulation.dt);
  law_.k_glass[run] = k_glass, law_.kt_glass[run] = kt_glass, law_.per_overlap[run] = per_overlap;
  law_.friction[run] = friction, law_.damping[run] = damping;
  law_.dt[run] = dt, law_.half_dt[run] = half_dt, law_.half_damping_dt[run] = half_damping_dt;
  const PerQuantum per = per_quantum(quanta_[run]);
  law_.per_force[run] = per.force, law_.per_torque[run] = per.torque, law_.per_energy[run] = per.energy;
  for (std::size_t row = 0; row < bead_of_.size(); ++row) {
    const std::size_t k = bead_of_[row];
    beads_.inertia[row].per_mass[run] = dt / simulation.beads.mass[k] * quanta_[run].force;
    beads_.inertia[row].per_inertia[run] = dt / simulation.beads.inertia[k] * quanta_[run].torque;
  }
}

void SideBySide::load_platen(std::size_t run, const Platen& from, SidePlaten& platen) {
  const auto [z, velocity, sign, k_glass, kt_glass, per_overlap, friction, damping, dt, half_damping_dt] =
      platen_numbers(from, runs_[run]->law, runs_[run]->dt);
  auto& to = platen.numbers;
  to.z[run] = z, to.velocity[run] = velocity, to.sign[run] = sign;
  to.k_glass[run] = k_glass, to.kt_glass[run] = kt_glass, to.per_overlap[run] = per_overlap;
  to.friction[run] = friction, to.damping[run] = damping;
  to.dt[run] = dt, to.half_damping_dt[run] = half_damping_dt;
  for (std::size_t row = 0; row < bead_of_.size(); ++row)
    put_bead(from, bead_of_[row], platen.beads[row], run);
}

void SideBySide::load_listing(std::size_t run) {
  const Listing& listing = runs_[run]->listing;
  for (std::size_t row = 0; row < bead_of_.size(); ++row) {
    const std::size_t k = bead_of_[row];
    SideInertia& bead = beads_.inertia[row];
    bead.listed_x[run] = static_cast<float>(listing.at[k].x());
    bead.listed_y[run] = static_cast<float>(listing.at[k].y());
    bead.listed_z[run] = static_cast<float>(listing.at[k].z());
    bead.per_margin_squared[run] = static_cast<float>(std::pow(listing.margin[k], -2));
  }
}

/// Pairs in the order of their first rows.
void SideBySide::load_places() {
  places_.clear();
  for (const Simulation* simulation : runs_) {
    if (!simulation) continue;
    const std::vector<char> may_touch = touchable(*simulation);
    for (std::size_t p = 0; p < may_touch.size(); ++p) {
      const Pair& pair = simulation->pairs[p];
      places_.push_back({pair.i, pair.j, kind_of(pair, may_touch[p] != 0), 0});
    }
  }
  std::sort(places_.begin(), places_.end());
  std::size_t kept = 0;
  for (const Place& place : places_) {
    const bool known = kept > 0 && !(places_[kept - 1] < place);
    if (known)
      places_[kept - 1].kind = of_both(places_[kept - 1].kind, place.kind);
    else
      places_[kept++] = place;
  }
  places_.resize(kept);

  std::vector<Place*> ordered;
  for (Place& place : places_) ordered.push_back(&place);
  const auto rows = [&](const Place* place) { return std::minmax(row_of_[place->i], row_of_[place->j]); };
  std::sort(ordered.begin(), ordered.end(),
            [&](const Place* a, const Place* b) { return rows(a) < rows(b); });
  for (SidePairs& pairs : tables_) pairs = {};
  for (Place* place : ordered)
    place->at =
        append(table(place->kind), {row_of_[place->i], row_of_[place->j]}, place->kind, parts_.bending);
  for (std::size_t run = 0; run < runs_.size(); ++run)
    if (runs_[run])
      for_pairs(run, [&](const Pair& pair, const Place& place) { put_pair(pair, in_table(place), run); });
  ordered_ = ordered.size();
}

PairPlace SideBySide::in_table(const Place& place) {
  SidePairs& pairs = table(place.kind);
  return {&pairs.columns[place.at], place.kind == PairKind::apart ? nullptr : &pairs.contacts[place.at],
          parts_.bending ? &pairs.bends[place.at] : nullptr};
}

void SideBySide::find_beads_near_platens() {
  bottom_.near.clear(), top_.near.clear();
  for (std::uint32_t row = 0; row < bead_of_.size(); ++row) {
    NearPlatens any = {false, false};
    for (const Simulation* simulation : runs_) {
      if (!simulation) continue;
      const NearPlatens near = near_platens(*simulation, bead_of_[row]);
      any = {any.bottom || near.bottom, any.top || near.top};
    }
    if (any.bottom) bottom_.near.push_back(row);
    if (any.top) top_.near.push_back(row);
  }
}

/// A pair that a run no longer lists stays in the tables, where it exerts no force in that run.
void SideBySide::list_anew(std::size_t run) {
  Simulation& simulation = *runs_[run];
  store_beads(run);
  list_pairs(simulation);
  load_listing(run);
  const std::vector<char> may_touch = touchable(simulation);
  std::vector<Place> missing;
  auto place = places_.begin();
  for (std::size_t p = 0; p < may_touch.size(); ++p) {
    const Place wanted = {simulation.pairs[p].i, simulation.pairs[p].j, PairKind::loose, 0};
    while (place != places_.end() && *place < wanted) ++place;
    if (place == places_.end() || wanted < *place)
      missing.push_back(wanted);
    else if (may_touch[p] && place->kind == PairKind::apart)
      let_touch(*place);
  }
  for (Place& one : missing)
    one.at = append(table(one.kind), {row_of_[one.i], row_of_[one.j]}, one.kind, parts_.bending);
  const auto known = static_cast<std::ptrdiff_t>(places_.size());
  places_.insert(places_.end(), missing.begin(), missing.end());
  std::inplace_merge(places_.begin(), places_.begin() + known, places_.end());
  find_beads_near_platens();
  std::size_t size = 0;
  for (const SidePairs& pairs : tables_) size += pairs.ends.size();
  if (size < ordered_ + ordered_ / kOutOfOrder) return;
  for (std::size_t k = 0; k < runs_.size(); ++k)
    if (runs_[k]) store(k);
  load();
}

/// Moves a pair to those that may touch. Its glass is apart as yet; in its old place a pair stays that never
/// acts.
void SideBySide::let_touch(Place& place) {
  SidePairs &apart = table(PairKind::apart), &touching = table(PairKind::touchable);
  const std::size_t before = place.at;
  place.kind = PairKind::touchable;
  place.at = append(touching, apart.ends[before], place.kind, parts_.bending);
  touching.columns[place.at] = std::exchange(apart.columns[before], {});
  if (parts_.bending) touching.bends[place.at] = std::exchange(apart.bends[before], {});
  const auto nowhere = static_cast<std::uint32_t>(bead_of_.size());
  apart.ends[before] = {nowhere, nowhere + 1};
  for (std::size_t run = 0; run < runs_.size(); ++run)
    if (const Pair* pair = runs_[run] ? find_pair(*runs_[run], place.i, place.j) : nullptr)
      touching.contacts[place.at].touch[run] = pair->properties.touch;
}

void SideBySide::store_beads(std::size_t run) {
  auto& beads = runs_[run]->beads;
  for (std::size_t row = 0; row < bead_of_.size(); ++row) {
    const BeadMotion now = motion(row, run);
    const std::size_t k = bead_of_[row];
    beads.position[k] = now.position, beads.velocity[k] = now.velocity, beads.spin[k] = now.spin;
  }
}

void SideBySide::store(std::size_t run) {
  store_beads(run);
  for (std::size_t row = 0; row < bead_of_.size(); ++row) {
    get_bead(bottom_.beads[row], run, bead_of_[row], runs_[run]->bottom);
    get_bead(top_.beads[row], run, bead_of_[row], runs_[run]->top);
  }
  for_pairs(run, [&](Pair& pair, const Place& place) { get_pair(in_table(place), run, pair); });
}

BeadMotion SideBySide::motion(std::size_t row, std::size_t run) const {
  const SideBead& bead = beads_.motion[row];
  return {{bead.x[run], bead.y[run], bead.z[run]},
          {bead.vx[run], bead.vy[run], bead.vz[run]},
          {bead.wx[run], bead.wy[run], bead.wz[run]},
          bead.radius[run]};
}

void SideBySide::stop(std::size_t run) {
  for (SidePairs& pairs : tables_)
    for (PairColumns& columns : pairs.columns) columns.kn[run] = columns.kt[run] = 0.0F;
  for (SideBead& bead : beads_.motion)
    for (double* number : {bead.vx, bead.vy, bead.vz, bead.wx, bead.wy, bead.wz}) number[run] = 0.0;
  for (SideInertia& bead : beads_.inertia) bead.per_mass[run] = bead.per_inertia[run] = 0.0;
  for (double* number : {law_.k_glass, law_.kt_glass, law_.friction, law_.damping, law_.dt, law_.half_dt,
                         law_.half_damping_dt})
    number[run] = 0.0;
  for (SidePlaten* platen : {&bottom_, &top_}) {
    auto& numbers = platen->numbers;
    for (double* number :
         {numbers.k_glass, numbers.kt_glass, numbers.damping, numbers.dt, numbers.half_damping_dt})
      number[run] = 0.0;
  }
  runs_[run] = nullptr;
}

}  // namespace pendular::dem_core
