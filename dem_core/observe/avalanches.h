#pragma once

#include <vector>

#include "dem_core/simulation.h"
#include "run_folder/events.h"

namespace pendular::dem_core {

/// Two breaks belong together where they are no farther apart than both.
struct AvalancheWindow {
  double strain = 0.0;
  double distance = 0.0;  ///< m
};

/// Three mean diameters, and the strain that a test at `rate` (1/s) makes while a sound wave along a chain of
/// bonds of stiffness `kn` runs that far, 3 √(m/kn). As Yade's JCFpm gathers cracks into acoustic events: in
/// a radius, and in the time that sound needs to its edge.
AvalancheWindow avalanche_window(const Simulation& simulation, double kn, double rate);

/// Clusters of the events, which come in order of time: what links of the window join, directly or through
/// other events. A break alone is an avalanche of one. In order of their first break.
std::vector<Avalanche> avalanches(const std::vector<BreakEvent>& events, const AvalancheWindow& window);

}  // namespace pendular::dem_core
