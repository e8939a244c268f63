#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dem_core/drive/bond_evolution.h"
#include "dem_core/simulation.h"
#include "dem_core/step/listed.h"
#include "dem_core/step/quanta.h"
#include "dem_core/step/side_by_side_tables.h"
#include "dem_core/step/stepping.h"

namespace pendular::dem_core {

/// Advances several simulations at once, one in each lane of a register: numbers of runs stand side by side,
/// so that nothing is gathered. All have one list of pairs, which is that of each run and more; a pair too
/// many exerts no force. Each simulation moves bit by bit as it does by a Stepper.
///
/// As with a Stepper, a simulation's platens, sums, events and step count are always true; its beads and
/// pairs are after store().
class SideBySide {
 public:
  /// Whether these can be advanced side by side, and had better be: at most kRuns, with the same parts of the
  /// law and the same beads in about the same places.
  static bool suits(std::span<Simulation* const> simulations);

  /// Of simulations that suit. They must outlive this.
  explicit SideBySide(std::span<Simulation* const> simulations);

  /// One time step of all runs that go on. Pairs of a run are listed anew as by a Stepper.
  void step();

  void store(std::size_t run);
  void change_bonds(std::size_t run, const BondEvolution& evolution, double elapsed);

  /// Goes on without this run; its simulation is no longer touched.
  void stop(std::size_t run);

  /// A run as its test sees it.
  class Run : public Stepping {
   public:
    Run(SideBySide& all, std::size_t run) : all_(all), run_(run) {}
    void store() override { all_.store(run_); }
    void change_bonds(const BondEvolution& evolution, double elapsed) override {
      all_.change_bonds(run_, evolution, elapsed);
    }

   private:
    SideBySide& all_;
    std::size_t run_;
  };

 private:
  /// Where the tables have a pair of beads, i < j.
  struct Place {
    int i, j;
    PairKind kind;
    std::size_t at;
    bool operator<(const Place& other) const { return i != other.i ? i < other.i : j < other.j; }
  };

  void load();
  void load_beads(std::size_t run, const Simulation& from);
  void load_law(std::size_t run);
  void load_platen(std::size_t run, const Platen& from, SidePlaten& platen);
  void load_listing(std::size_t run);
  void load_places();
  void find_beads_near_platens();
  void list_anew(std::size_t run);
  void let_touch(Place& place);
  SidePairs& table(PairKind kind) { return tables_[static_cast<std::size_t>(kind)]; }
  PairPlace in_table(const Place& place);
  /// Calls f(pair, place) for every pair of a run.
  template <typename Function>
  void for_pairs(std::size_t run, const Function& f) {
    auto place = places_.begin();
    for (Pair& pair : runs_[run]->pairs) {
      while (place->i != pair.i || place->j != pair.j) ++place;
      f(pair, *place);
    }
  }
  void store_beads(std::size_t run);
  BeadMotion motion(std::size_t row, std::size_t run) const;
  void press_platens();
  void break_bonds(const std::vector<SideBreak> (&noted)[3]);
  void end_step(std::size_t run);

  std::vector<Simulation*> runs_;  ///< none: its run has stopped
  std::vector<Quanta> quanta_;
  LawParts parts_;
  std::vector<std::size_t> bead_of_;   ///< row of the tables → bead
  std::vector<std::uint32_t> row_of_;  ///< bead → row
  std::vector<Place> places_;          ///< sorted
  std::size_t ordered_ = 0;  ///< pairs of the tables when they were loaded; others are at their ends
  SideBeads beads_;
  SidePairs tables_[3];  ///< one of each kind
  SideLaw law_ = {};
  SideTotals totals_ = {};
  SidePlaten bottom_, top_;
};

}  // namespace pendular::dem_core
