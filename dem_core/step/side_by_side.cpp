#include "dem_core/step/side_by_side.h"

#include <algorithm>
#include <tuple>

#include "dem_core/step/flush_denormals.h"
#include "dem_core/step/platen_kernels.h"
#include "dem_core/step/side_by_side_kernels.h"

namespace pendular::dem_core {
namespace {

constexpr PairKind kKinds[] = {PairKind::apart, PairKind::touchable, PairKind::loose};

}  // namespace

void SideBySide::step() {
  std::vector<SideBreak> breaking[3];
  {
    const FlushDenormals here;
    totals_ = {};
    for (const PairKind kind : kKinds)
      advance_side_by_side(table(kind), kind, beads_, law_, parts_, totals_,
                           breaking[static_cast<std::size_t>(kind)]);
    press_platens();
    move_side_by_side(beads_, bead_of_.size(), law_, totals_);
  }
  break_bonds(breaking);
  for (std::size_t run = 0; run < runs_.size(); ++run)
    if (runs_[run]) end_step(run);
}

void SideBySide::press_platens() {
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    if (!runs_[run]) continue;
    bottom_.numbers.z[run] = runs_[run]->bottom.z, top_.numbers.z[run] = runs_[run]->top.z;
    bottom_.numbers.velocity[run] = runs_[run]->bottom.velocity;
    top_.numbers.velocity[run] = runs_[run]->top.velocity;
  }
  press_side_by_side(bottom_, beads_, law_, parts_, totals_.bottom, totals_);
  press_side_by_side(top_, beads_, law_, parts_, totals_.top, totals_);
}

/// Breaks are taken when all beads have moved, those of a run in the order of its pairs.
void SideBySide::break_bonds(const std::vector<SideBreak> (&noted)[3]) {
  std::vector<std::tuple<std::size_t, Place>> breaking;
  for (const PairKind kind : kKinds)
    for (const auto& [at, run] : noted[static_cast<std::size_t>(kind)]) {
      const auto [i, j] = table(kind).ends[at];
      breaking.push_back({run, {static_cast<int>(bead_of_[i]), static_cast<int>(bead_of_[j]), kind, at}});
    }
  std::sort(breaking.begin(), breaking.end());
  for (const auto& [run, place] : breaking) {
    Simulation& simulation = *runs_[run];
    Pair& pair = *find_pair(simulation, place.i, place.j);
    for (const int bead : {place.i, place.j})
      simulation.beads.position[bead] = motion(row_of_[bead], run).position;
    get_pair(in_table(place), run, pair);
    break_bond(simulation, pair);
    put_pair(pair, in_table(place), run);
  }
}

void SideBySide::end_step(std::size_t run) {
  Simulation& simulation = *runs_[run];
  simulation.bottom.force = quanta_[run].force * static_cast<double>(totals_.bottom[run]);
  simulation.top.force = quanta_[run].force * static_cast<double>(totals_.top[run]);
  simulation.work.damped += quanta_[run].energy * static_cast<double>(totals_.damped[run]);
  simulation.work.slipped += quanta_[run].energy * static_cast<double>(totals_.slipped[run]);
  advance_platens(simulation);
  if (listing_due(simulation, totals_.farthest[run])) list_anew(run);
}

void SideBySide::change_bonds(std::size_t run, const BondEvolution& evolution, double elapsed) {
  store(run);
  Simulation& simulation = *runs_[run];
  std::vector<Pair*> bonded;
  for (Pair& pair : simulation.pairs)
    if (pair.bond >= 0) bonded.push_back(&pair);
  if (evolution.change)
    for (Pair* pair : bonded) change_bond(simulation, *pair, evolution, elapsed);
  if (evolution.change_all) {
    std::sort(bonded.begin(), bonded.end(), [](const Pair* a, const Pair* b) { return a->bond < b->bond; });
    change_all_bonds(simulation, bonded, evolution, elapsed);
  }
  for_pairs(run, [&](const Pair& pair, const Place& place) {
    if (pair.bond >= 0) put_pair(pair, in_table(place), run);
  });
}

}  // namespace pendular::dem_core
