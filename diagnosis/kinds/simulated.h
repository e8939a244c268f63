#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/vec3.h"
#include "dem_core/observe/curve.h"
#include "diagnosis/experiment/observation.h"
#include "effects/effect.h"

namespace pendular::diagnosis {

/// Two beads' ids, the smaller first.
using PairOfIds = std::pair<std::int64_t, std::int64_t>;

/// A specimen as a simulated scan shows it. SI.
struct Frame {
  double strain =
      0.0;  ///< platen strain: as it is in a run's frames, as it is read once an instrument read it
  double stress = 0.0;  ///< Pa
  std::vector<std::int64_t> ids;
  std::vector<Vec3> rest, displacement;
  std::vector<PairOfIds> standing, broken;  ///< bonds, in rising order
};

/// A simulated test as its instruments report it.
struct SimulatedTest {
  fs::path folder;
  std::vector<CurveRow> rows;
  effects::Gauge gauge{};
  double coordination = 0.0;  ///< bridges per interior bead
  std::vector<Frame> frames;  ///< rising in strain
};

/// The strain of a frame that stands for the specimen at rest.
inline constexpr double kRestStrain = 1e-3;

/// Reads a run folder. BadInput where it is damaged.
SimulatedTest read_simulated_test(const fs::path& folder);

/// Leaves out what a test shows beyond this strain of the run.
void end_at(double strain, SimulatedTest& test);

/// Frames by the strain and the lengths that instruments with an effect show: a run's frames have the true
/// ones.
void read_frames(const effects::Effect& effect, double theta, SimulatedTest& test);
/// Rows and frames of a test that was made without the effect.
void read_test(const effects::Effect& effect, double theta, SimulatedTest& test);

/// The frame whose platen strain, as the instruments read it, is nearest to this one. BadInput where the run
/// kept none.
const Frame& frame_near(const SimulatedTest& test, double strain);

/// Columns "strain" and one more of a test's rows.
Columns columns_of_rows(const SimulatedTest& test, const std::string& name, double CurveRow::*value);

/// A point that supports a simulated modulus series: E_p or W, and E.
struct SeriesPoint {
  double at = 0.0, modulus = 0.0;
};

/// E of a simulated curve; NaN where it has no linear part.
double simulated_modulus(const SimulatedTest& test);

/// The columns of a modulus series: at the observed E_p or W, log E by straight lines in its logarithm
/// between the points.
Columns columns_of_series(const Observation& observation, std::vector<SeriesPoint> points);

}  // namespace pendular::diagnosis
