#pragma once

#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// One time step, one pair after the other: slow and readable, the judge of Stepper. Reads and writes the
/// simulation alone; lists no pairs anew.
void reference_step(Simulation& simulation);

}  // namespace pendular::dem_core
