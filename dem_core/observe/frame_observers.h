#pragma once

#include <cstdint>
#include <vector>

#include "dem_core/simulation.h"
#include "packing/polydata.h"

namespace pendular::dem_core {

/// A standing bond, a broken bond, or a touching pair without a bond: a line of a frame.
struct Link {
  int i = 0, j = 0;
  std::int64_t state = 0;     ///< 0, 1, 2 in the order above
  double normal_force = 0.0;  ///< N, pushing positive
};
std::vector<Link> links(const Simulation& simulation);

/// Reads a simulation and adds arrays to its frame, where the sample's [observe] has it switched on.
struct FrameObserver {
  bool Sample::Observe::*switched_on;
  void (*add)(const Simulation& simulation, const std::vector<Link>& links, PolyTable& frame);
};

/// All of them, in the order of a frame's arrays: a new one is a function and its line here.
const std::vector<FrameObserver>& frame_observers();

}  // namespace pendular::dem_core
