#pragma once

#include <vector>

#include "dem_core/drive/platen_program.h"
#include "dem_core/observe/curve.h"
#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// A compression test under way.
struct RunState {
  Simulation simulation;
  std::vector<CurveRow> rows;
  int frames_written = 0;
  PlatenProgress platen;
  bool finished = false;

  /// Sums over the steps of the row under way.
  struct OpenRow {
    double strain = 0.0, top = 0.0, bottom = 0.0;
    int steps = 0;
  } open_row;
};

}  // namespace pendular::dem_core
