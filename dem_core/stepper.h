#pragma once

#include <vector>

#include "dem_core/simulation.h"

namespace pendular {

/// Advances a simulation step by step: leapfrog, two passes and no atomics. Each pair writes its force into
/// its own slot; each bead then gathers its slots in fixed order, so that sums do not depend on the thread
/// count. Holds only what can be made anew from the simulation: building one anew changes no result.
class Stepper {
 public:
  explicit Stepper(Simulation& simulation);

  /// One time step. Pairs are listed anew where a bead has moved half a skin.
  void step();

 private:
  void index_slots();
  void move_beads();
  void advance_pairs();
  void gather_forces();
  void collect_breaks();
  Vec3 platen_contact(std::size_t bead, Platen& platen, Vec3& torque, double& normal, double& damped,
                      double& slipped) const;

  /// A bead's view of one of its pairs.
  struct Slot {
    int pair;
    double sign;  ///< +1: the bead is i of the pair
  };
  struct BlockSums {
    double damped = 0.0, slipped = 0.0, bottom = 0.0, top = 0.0, farthest_squared = 0.0;
    bool any_break = false;
  };

  Simulation& simulation_;
  std::vector<PairForce> forces_;
  std::vector<int> first_slot_;
  std::vector<Slot> slots_;
  std::vector<BlockSums> pair_sums_, bead_sums_;
};

}  // namespace pendular
