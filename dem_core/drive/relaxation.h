#pragma once

#include <optional>

#include "dem_core/step/stepper.h"

namespace pendular::dem_core {

/// One increment of a quasi-static test.
struct Increment {
  double strain = 1e-3;      ///< of the platen's travel
  double unbalanced = 1e-3;  ///< at rest where unbalanced_force() is no larger
};

/// What an increment came to.
struct Relaxed {
  int steps = 0;
  double unbalanced =
      0.0;  ///< unbalanced_force() at the end; above the one asked for where it would not rest
};

/// Lets the specimen come to rest between platens that stand still: it is halted each time that its kinetic
/// energy has passed a maximum (kinetic damping: Cundall 1976; Barnes 1999, Int. J. Space Struct. 14, 89),
/// until unbalanced_force() is no larger than asked for. Nothing where the user interrupts.
std::optional<Relaxed> come_to_rest(Simulation& simulation, Stepper& stepper, double unbalanced);

/// Moves the platen by one increment, all beads set in motion with the mean deformation, and lets the
/// specimen come to rest once it has arrived. No speed enters the result, and an oscillation is halted before
/// it overshoots. What halting takes out, less what setting in motion brought, is booked as Work::halted.
///
/// Nothing where the user interrupts: simulation and stepper are then in between and of no use.
std::optional<Relaxed> compress_and_relax(Simulation& simulation, Stepper& stepper,
                                          const Increment& increment);

}  // namespace pendular::dem_core
