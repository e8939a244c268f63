#include "dem_core/step/stepper.h"

#include <algorithm>
#include <cmath>

#include "dem_core/step/flush_denormals.h"
#include "dem_core/step/listed.h"
#include "dem_core/step/platen_kernels.h"
#include "dem_core/step/step_kernels.h"

namespace pendular::dem_core {
Stepper::Stepper(Simulation& simulation) : simulation_(simulation), quanta_(quanta(simulation)) {
  load();
}

void Stepper::load() {
  order_beads();
  load_beads();
  cut_chunks();
  load_pairs();
  share_sums();
  find_beads_near_platens();
  share_chunks();
}

/// Gives each thread chunks that follow each other, with as many pairs as the others have.
void Stepper::share_chunks() {
  const std::size_t blocks = pairs_.blocks.size(), threads = std::min(thread_count(), chunks_.size());
  shares_.clear();
  for (std::size_t c = 0; shares_.size() < threads;) {
    const std::size_t first = c, enough = blocks * (shares_.size() + 1) / threads;
    while (c < chunks_.size() && (chunks_[c].first_block + chunks_[c].last_block) / 2 < enough) ++c;
    shares_.push_back({first, c});
  }
  shares_.back().last = chunks_.size();
  taken_ = std::vector<Taken>(chunks_.size());
}

void Stepper::step() {
  for_shares(shares_.size(), [&](std::size_t share) { advance_share(share); });
  for_shares(shares_.size(), [&](std::size_t share) { move_share(share); });
  add_up();
  break_bonds();
  advance_platens(simulation_);
  if (!listing_due()) return;
  store();
  list_pairs(simulation_);
  load();
}

double Stepper::kinetic_energy() const {
  const auto& beads = simulation_.beads;
  double energy = 0.0;
  for (std::size_t row = 0; row < beads_.size; ++row) {
    const double *bead = &beads_.motion[kBeadRow * row], *spin = &beads_.spin[kBeadRow * row];
    energy += 0.5 * beads.mass[bead_of_[row]] * get(bead + 4).squaredNorm();
    energy += 0.5 * beads.inertia[bead_of_[row]] * get(spin).squaredNorm();
  }
  return energy;
}

// Positions are one step ahead of what pairs remember: a velocity that is taken or given takes or gives the
// displacement of one step with it. Of a step in which the platen sets out or stops it moves half.
void Stepper::halt() {
  Platen& platen = simulation_.bottom;
  simulation_.work.platen -= 0.5 * simulation_.dt * platen.force * platen.velocity;
  simulation_.work.halted += kinetic_energy();
  platen.z -= simulation_.dt * platen.velocity;
  platen.velocity = 0.0;
  for (std::size_t row = 0; row < beads_.size; ++row) {
    double* bead = &beads_.motion[kBeadRow * row];
    put(bead, get(bead) - simulation_.dt * get(bead + 4));
    put(bead + 4, Vec3::Zero());
    put(&beads_.spin[kBeadRow * row], Vec3::Zero());
  }
}

void Stepper::set_in_motion(double speed, const std::function<Vec3(const Vec3&)>& velocity) {
  Platen& platen = simulation_.bottom;
  platen.velocity = speed;
  simulation_.work.platen += 0.5 * simulation_.dt * platen.force * speed;
  platen.z += simulation_.dt * speed;
  for (std::size_t row = 0; row < beads_.size; ++row) {
    double* bead = &beads_.motion[kBeadRow * row];
    const Vec3 v = velocity(get(bead));
    put(bead + 4, v);
    put(bead, get(bead) + simulation_.dt * v);
  }
  simulation_.work.halted -= kinetic_energy();
}

/// A share's own chunks from its first on, then from the last on what others have not taken yet, but for the
/// last one left of each: what a chunk brings with it from another core takes as long as waiting for it.
void Stepper::advance_share(std::size_t share) {
  const FlushDenormals here;
  const auto is_taken = [&](std::size_t c) { return taken_[c].flag.load(std::memory_order_relaxed); };
  const auto take = [&](std::size_t c) {
    if (!is_taken(c) && !taken_[c].flag.exchange(true, std::memory_order_relaxed)) advance_chunk(c);
  };
  for (std::size_t c = shares_[share].first; c < shares_[share].last; ++c) take(c);
  for (std::size_t other = 1; other < shares_.size(); ++other) {
    const Share& of = shares_[(share + other) % shares_.size()];
    for (std::size_t c = of.last; c > of.first + 1 && !is_taken(c - 2); --c) take(c - 1);
  }
}

void Stepper::move_share(std::size_t share) {
  const FlushDenormals here;
  for (std::size_t c = shares_[share].first; c < shares_[share].last; ++c) {
    move_beads(beads_, chunks_[c], simulation_.dt);
    taken_[c].flag.store(false, std::memory_order_relaxed);
  }
}

void Stepper::advance_chunk(std::size_t c) {
  Chunk& chunk = chunks_[c];
  chunk.damped = chunk.slipped = chunk.bottom = chunk.top = 0;
  chunk.breaking.clear();
  advance_pairs(pairs_, beads_, chunk, numbers(simulation_.law, simulation_.dt), parts(simulation_.law),
                per_quantum(quanta_));
  press_platens(chunk);
}

/// Makes the simulation's pair true, and has it changed there.
template <typename Change>
void Stepper::change_pair(const Chunk& chunk, std::size_t p, const Change& change) {
  Pair& pair = simulation_.pairs[pair_of_[p]];
  for (int bead : {pair.i, pair.j}) simulation_.beads.position[bead] = motion(row_of_[bead]).position;
  store_pair(chunk, p);
  change(simulation_, pair);
  load_pair(chunk, p);
}

/// Breaks are taken when all beads have moved, in the order of the simulation's pairs.
void Stepper::break_bonds() {
  std::vector<PlaceOfPair> breaking;
  for (const auto& chunk : chunks_)
    for (const std::uint32_t p : chunk.breaking) breaking.push_back({pair_of_[p], &chunk, p});
  std::sort(breaking.begin(), breaking.end());
  for (const auto& [pair, chunk, p] : breaking)
    change_pair(*chunk, p, [](Simulation& s, Pair& broken) { break_bond(s, broken); });
}

/// Of the pairs that are bonded, in the order of the simulation's.
std::vector<Stepper::PlaceOfPair> Stepper::bonded() const {
  std::vector<PlaceOfPair> found;
  for (const auto& chunk : chunks_)
    for (std::size_t p = chunk.first_block * kBlock; p < chunk.last_block * kBlock; ++p)
      if (pair_of_[p] >= 0 && simulation_.pairs[pair_of_[p]].bond >= 0)
        found.push_back({pair_of_[p], &chunk, p});
  std::sort(found.begin(), found.end());
  return found;
}

void Stepper::change_bonds(const BondEvolution& evolution, double elapsed) {
  const std::vector<PlaceOfPair> places = bonded();
  if (evolution.change)
    for (const auto& [pair, chunk, p] : places)
      change_pair(*chunk, p, [&](Simulation& s, Pair& one) { change_bond(s, one, evolution, elapsed); });
  if (!evolution.change_all) return;
  store();
  std::vector<Pair*> all;
  for (const auto& place : places) all.push_back(&simulation_.pairs[place.pair]);
  std::sort(all.begin(), all.end(), [](const Pair* a, const Pair* b) { return a->bond < b->bond; });
  change_all_bonds(simulation_, all, evolution, elapsed);
  for (const auto& [pair, chunk, p] : places) load_pair(*chunk, p);
}

void Stepper::press_platens(Chunk& chunk) {
  const auto press = [&](const Platen& platen, AlignedVector<PlatenBlock>& near, std::int64_t& force) {
    const PlatenTotals total =
        press_beads(near, beads_, platen_numbers(platen, simulation_.law, simulation_.dt),
                    parts(simulation_.law), per_quantum(quanta_));
    force = total.force;
    add(chunk.damped, total.damped), add(chunk.slipped, total.slipped);
  };
  press(simulation_.bottom, chunk.near_bottom, chunk.bottom);
  press(simulation_.top, chunk.near_top, chunk.top);
}

void Stepper::add_up() {
  std::int64_t bottom = 0, top = 0, damped = 0, slipped = 0;
  for (const auto& chunk : chunks_) {
    add(bottom, chunk.bottom), add(top, chunk.top);
    add(damped, chunk.damped), add(slipped, chunk.slipped);
  }
  simulation_.bottom.force = quanta_.force * static_cast<double>(bottom);
  simulation_.top.force = quanta_.force * static_cast<double>(top);
  simulation_.work.damped += quanta_.energy * static_cast<double>(damped);
  simulation_.work.slipped += quanta_.energy * static_cast<double>(slipped);
}

bool Stepper::listing_due() const {
  double farthest = 0.0;
  for (const auto& chunk : chunks_) farthest = std::max(farthest, chunk.farthest);
  return dem_core::listing_due(simulation_, farthest);
}

}  // namespace pendular::dem_core
