#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/buckets.h"
#include "base/parallel.h"
#include "dem_core/step/listed.h"
#include "dem_core/step/stepper.h"

namespace pendular::dem_core {
namespace {

constexpr std::size_t kBeadsPerChunk = 256, kPairsPerBlock = 2048;

std::size_t filled_up(std::size_t size) {
  return (size + kBlock - 1) / kBlock * kBlock;
}

/// Appends full blocks of pairs to the table so that pairs that follow each other in their order, and share a
/// bead, are in blocks that follow each other: additions to one sum wait for each other. Pairs stay near
/// their place.
void append_apart(std::span<const std::size_t> ordered, std::vector<std::int64_t>& table) {
  constexpr std::size_t kSpread = 16;
  const std::size_t all = filled_up(ordered.size()) / kBlock;
  for (std::size_t first = 0; first < all; first += kSpread) {
    const std::size_t blocks = std::min(kSpread, all - first);
    for (std::size_t b = 0; b < blocks; ++b)
      for (std::size_t lane = 0; lane < kBlock; ++lane) {
        const std::size_t from = first * kBlock + lane * blocks + b;
        table.push_back(from < ordered.size() ? static_cast<std::int64_t>(ordered[from]) : -1);
      }
  }
}

/// In which of a chunk's groups a pair stands: of a kind, bonds whose glass touches after those whose glass
/// is apart, so that blocks are of either.
enum Group : std::size_t { kApart, kResting, kTouching, kLoose, kGroups };

std::vector<Group> groups_of(const Simulation& simulation) {
  const std::vector<char> may_touch = touchable(simulation);
  std::vector<Group> found(may_touch.size());
  for_blocks(found.size(), kPairsPerBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const Pair& pair = simulation.pairs[p];
      const auto touches = [&] { return gap(simulation, pair) <= pair.properties.touch; };
      found[p] = pair.bond < 0 ? kLoose : !may_touch[p] ? kApart : touches() ? kTouching : kResting;
    }
  });
  return found;
}

}  // namespace

void Stepper::order_beads() {
  bead_of_ = beads_in_space(simulation_);
  row_of_.resize(bead_of_.size());
  for (std::size_t row = 0; row < bead_of_.size(); ++row)
    row_of_[bead_of_[row]] = static_cast<std::int32_t>(row);
}

void Stepper::load_beads() {
  const auto& beads = simulation_.beads;
  const std::size_t size = beads_.size = beads.size();
  // Two more rows, apart by one metre, are the beads of the pairs that fill up blocks.
  beads_.motion.assign(kBeadRow * (size + 2), 0.0);
  beads_.motion[kBeadRow * (size + 1)] = 1.0;
  beads_.spin.assign(kBeadRow * (size + 2), 0.0);
  beads_.listed_rows.assign(4 * size, 0.0F);
  for (std::size_t row = 0; row < size; ++row) {
    const std::size_t k = bead_of_[row];
    double* bead = &beads_.motion[kBeadRow * row];
    double* spin = &beads_.spin[kBeadRow * row];
    put(bead, beads.position[k]);
    put(bead + 4, beads.velocity[k]);
    put(spin, beads.spin[k]);
    bead[3] = spin[3] = beads.radius[k];
    bead[7] = simulation_.dt / beads.mass[k] * quanta_.force;
    spin[4] = simulation_.dt / beads.inertia[k] * quanta_.torque;
    spin[5] = std::pow(simulation_.listing.margin[k], -2);
    float* listed = &beads_.listed_rows[4 * row];
    for (int axis = 0; axis < 3; ++axis) listed[axis] = static_cast<float>(simulation_.listing.at[k][axis]);
    listed[3] = static_cast<float>(beads.radius[k]);
  }
}

/// Cuts the rows of beads into chunks and gives each pair to the chunk of its first row. In a group pairs are
/// in the order of their first rows.
void Stepper::cut_chunks() {
  const auto& pairs = simulation_.pairs;
  const std::size_t chunks = (beads_.size + kBeadsPerChunk - 1) / kBeadsPerChunk;
  const std::vector<Group> group = groups_of(simulation_);
  std::vector<std::size_t> place(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto row = static_cast<std::size_t>(std::min(row_of_[pairs[p].i], row_of_[pairs[p].j]));
    place[p] = (row / kBeadsPerChunk * kGroups + group[p]) * kBeadsPerChunk + row % kBeadsPerChunk;
  }
  const auto [first, ordered] = sort_by_number(place, kGroups * chunks * kBeadsPerChunk);

  chunks_.assign(chunks, {});
  pair_of_.clear();
  std::size_t contacts = 0, reaches = 0;
  for (std::size_t c = 0; c < chunks; ++c) {
    std::size_t begin[kGroups + 1];
    for (std::size_t g = 0; g < kGroups; ++g) {
      begin[g] = pair_of_.size() / kBlock;
      const std::size_t from = first[(c * kGroups + g) * kBeadsPerChunk],
                        to = first[(c * kGroups + g + 1) * kBeadsPerChunk];
      append_apart(std::span(ordered).subspan(from, to - from), pair_of_);
    }
    begin[kGroups] = pair_of_.size() / kBlock;
    Chunk& chunk = chunks_[c];
    chunk.first_bead = c * kBeadsPerChunk;
    chunk.last_bead = std::min(beads_.size, chunk.first_bead + kBeadsPerChunk);
    chunk.first_block = begin[kApart], chunk.touchable = begin[kResting], chunk.loose = begin[kLoose];
    chunk.last_block = begin[kGroups];
    chunk.first_contact = contacts, chunk.first_reach = reaches;
    contacts += chunk.last_block - chunk.touchable, reaches += chunk.last_block - chunk.loose;
  }
}

void Stepper::load_pairs() {
  const auto ghost = static_cast<std::uint32_t>(kBeadRow * beads_.size);
  PairBlock empty{};
  std::fill_n(empty.i, kBlock, ghost);
  std::fill_n(empty.j, kBlock, ghost + kBeadRow);
  pairs_.blocks.assign(pair_of_.size() / kBlock, empty);
  pairs_.bends.assign(simulation_.law.bending ? pairs_.blocks.size() : 0, BendBlock{});
  const Chunk& last = chunks_.back();
  pairs_.contacts.assign(last.first_contact + last.last_block - last.touchable, ContactBlock{});
  pairs_.glass_apart.assign(pairs_.contacts.size(), 0);
  pairs_.reaches.assign(last.first_reach + last.last_block - last.loose, ReachBlock{});
  for_pairs([&](const Chunk& chunk, std::size_t p) { load_pair(chunk, p); });
}

/// Calls f(chunk, place) for every pair of the table, chunks side by side.
template <typename Function>
void Stepper::for_pairs(const Function& f) {
  for_blocks(chunks_.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c)
      for (std::size_t p = chunks_[c].first_block * kBlock; p < chunks_[c].last_block * kBlock; ++p)
        if (pair_of_[p] >= 0) f(chunks_[c], p);
  });
}

/// The contact block of a pair, or none.
ContactBlock* Stepper::contact_of(const Chunk& chunk, std::size_t p) {
  const std::size_t b = p / kBlock;
  return b < chunk.touchable ? nullptr : &pairs_.contacts[chunk.first_contact + b - chunk.touchable];
}

/// Its bend block, or none.
BendBlock* Stepper::bend_of(std::size_t p) {
  return pairs_.bends.empty() ? nullptr : &pairs_.bends[p / kBlock];
}

void Stepper::load_pair(const Chunk& chunk, std::size_t p) {
  const Pair& pair = simulation_.pairs[pair_of_[p]];
  const std::size_t at = p % kBlock;
  PairBlock& block = pairs_.blocks[p / kBlock];
  block.i[at] = kBeadRow * row_of_[pair.i], block.j[at] = kBeadRow * row_of_[pair.j];
  put_pair(pair, {&block.columns, contact_of(chunk, p), bend_of(p)}, at);
  if (p / kBlock < chunk.loose) return;
  const double reach =
      simulation_.beads.radius[pair.i] + simulation_.beads.radius[pair.j] + pair.properties.touch;
  pairs_.reaches[chunk.first_reach + p / kBlock - chunk.loose].squared[at] = (1.0 + 1e-9) * reach * reach;
}

void Stepper::store_pair(const Chunk& chunk, std::size_t p) {
  get_pair({&pairs_.blocks[p / kBlock].columns, contact_of(chunk, p), bend_of(p)}, p % kBlock,
           simulation_.pairs[pair_of_[p]]);
}

/// A chunk adds to the sums of its own beads, and to sums of its own making for those of others.
void Stepper::share_sums() {
  std::uint32_t next = static_cast<std::uint32_t>(beads_.size);
  std::vector<std::uint32_t> sum_of(beads_.size);  // of a row, where the chunk at hand has met it
  std::vector<std::size_t> met_by(beads_.size, chunks_.size());
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const auto place = [&](std::uint32_t row) {
      const std::size_t owner = row / kBeadsPerChunk;
      if (owner == c) return row;
      if (met_by[row] != c) {
        met_by[row] = c;
        sum_of[row] = next++;
        chunks_[owner].incoming.push_back({sum_of[row], row});
        chunks_[c].foreign.push_back(kBeadRow * row);
      }
      return sum_of[row];
    };
    const std::uint32_t nowhere = next++;  // for the pairs that fill up
    for (std::size_t p = chunks_[c].first_block * kBlock; p < chunks_[c].last_block * kBlock; ++p) {
      const bool fills_up = pair_of_[p] < 0;
      PairBlock& block = pairs_.blocks[p / kBlock];
      const std::size_t at = p % kBlock;
      block.sum_i[at] = kBeadRow * (fills_up ? nowhere : place(block.i[at] / kBeadRow));
      block.sum_j[at] = kBeadRow * (fills_up ? nowhere : place(block.j[at] / kBeadRow));
    }
  }
  beads_.sums.assign(kBeadRow * static_cast<std::size_t>(next), 0);
}

void Stepper::find_beads_near_platens() {
  for (auto& chunk : chunks_) {
    std::size_t bottom = 0, top = 0;
    const auto append = [&](const Platen& platen, std::size_t row, AlignedVector<PlatenBlock>& near,
                            std::size_t& count) {
      const std::size_t at = count++ % kBlock;
      if (at == 0) {
        PlatenBlock& fresh = near.emplace_back();
        std::fill_n(fresh.row, kBlock, kBeadRow * static_cast<std::uint32_t>(row));
        std::fill_n(fresh.columns.relief, kBlock, 1.0);
      }
      near.back().row[at] = kBeadRow * static_cast<std::uint32_t>(row);
      put_bead(platen, bead_of_[row], near.back().columns, at);
    };
    for (std::size_t row = chunk.first_bead; row < chunk.last_bead; ++row) {
      const NearPlatens near = near_platens(simulation_, bead_of_[row]);
      if (near.bottom) append(simulation_.bottom, row, chunk.near_bottom, bottom);
      if (near.top) append(simulation_.top, row, chunk.near_top, top);
    }
  }
}

void Stepper::store_platen(const AlignedVector<PlatenBlock>& near, Platen& platen) {
  for (const PlatenBlock& block : near)
    for (std::size_t at = 0; at < kBlock; ++at)
      if (at == 0 || block.row[at] != block.row[0])
        get_bead(block.columns, at, bead_of_[block.row[at] / kBeadRow], platen);
}

BeadMotion Stepper::motion(std::size_t row) const {
  const double* bead = &beads_.motion[kBeadRow * row];
  return {get(bead), get(bead + 4), get(&beads_.spin[kBeadRow * row]), bead[3]};
}

void Stepper::store() {
  auto& beads = simulation_.beads;
  for (std::size_t row = 0; row < beads_.size; ++row) {
    const std::size_t k = bead_of_[row];
    const BeadMotion bead = motion(row);
    beads.position[k] = bead.position;
    beads.velocity[k] = bead.velocity;
    beads.spin[k] = bead.spin;
  }
  for_pairs([&](const Chunk& chunk, std::size_t p) { store_pair(chunk, p); });
  for (const auto& chunk : chunks_)
    store_platen(chunk.near_bottom, simulation_.bottom), store_platen(chunk.near_top, simulation_.top);
}

}  // namespace pendular::dem_core
