#pragma once

#include <functional>
#include <vector>

#include "dem_core/curve.h"
#include "diagnosis/conditions.h"
#include "diagnosis/features.h"
#include "effects/effect.h"

namespace pendular::diagnosis {

/// A simulated test as its instruments report it.
struct SimulatedTest {
  fs::path folder;
  std::vector<CurveRow> rows;
  effects::Gauge gauge{};
  double coordination = 0.0;  ///< bridges per interior bead
};

/// Reads a run folder. BadInput where it is damaged.
SimulatedTest read_simulated_test(const fs::path& folder);

/// The columns that an observation of `kind` compression, lateral_strain, coordination, displacements or
/// broken_bonds would have had. Displacements are those of the beads that were followed, scaled from the
/// nearest frame to the strain observed.
Columns columns_of_test(const Observation& observation, const SimulatedTest& test);

/// A point that supports a simulated modulus series: E_p or W, and E.
struct SeriesPoint {
  double at = 0.0, modulus = 0.0;
};

/// E of a simulated curve; NaN where it has no linear part.
double simulated_modulus(const SimulatedTest& test);

/// The columns of a modulus series: at the observed E_p or W, log E by straight lines in its logarithm
/// between the points.
Columns columns_of_series(const Observation& observation, std::vector<SeriesPoint> points);

/// The columns of single-bridge tests, diameters or gaps, by what `sample` says of its bridges: each tested
/// bridge's stiffness by finite elements from its own diameter (scaled to the stated stiffness, where one is
/// stated); diameters of the stated mean, and of the larger of the stated spread and that of the effect
/// bridge_diameter_spread; gaps of the stated one and the mean excess of bridge_gap_spread.
Columns columns_of_bridges(const Observation& observation, const Sample& sample);

}  // namespace pendular::diagnosis
