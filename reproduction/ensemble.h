#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "run_folder/run_folder.h"
#include "sweep/execute.h"
#include "sweep/plan.h"

namespace pendular::reproduction {

/// One point of a sweep with those of its runs that are done.
struct Point {
  Sample sample;                            ///< of all its runs
  std::vector<sweep::RunRequest> requests;  ///< one per run
  std::vector<RunFolder> runs;
};

/// The points of a plan, in its order, read from its runs' folders.
std::vector<Point> read_points(const sweep::Plan& plan, std::span<const sweep::RunOutcome> outcomes);

/// Mean and standard deviation of the values that are finite; NaN where there are too few.
struct Spread {
  double mean = std::nan(""), sd = std::nan("");
  std::size_t count = 0;
};
Spread spread_of(std::span<const double> values);

/// A number read off a run; NaN where the run does not have it.
using Quantity = double (*)(const RunFolder&);
Spread spread_of(const Point& point, Quantity quantity);

/// What the report asks of a run. Strains count from the toe, SI.
double modulus(const RunFolder& run);
double linear_limit(const RunFolder& run);
double peak_strain(const RunFolder& run);
double peak_stress(const RunFolder& run);
double coordination_number(const RunFolder& run);
double broken_share_before_limit(const RunFolder& run);  ///< of all bonds
double stress_kept(const RunFolder& run);                ///< stress at the end over the highest
double band_contrast(const RunFolder& run);              ///< NaN where no band was found

/// Change of volume at mid-height at the highest stress, 2 × lateral − axial strain: positive where it
/// swells.
double volume_change_at_peak(const RunFolder& run);

/// Least-squares slope of stress over the platen strains 2 to 3 %, Pa: a modulus at a strain that does not
/// depend on where a curve ends or breaks.
double slope_at_fixed_strain(const RunFolder& run);

/// "41.1 ± 0.9", the sd left out where there is none; values over `unit`. A dash where there is no value.
std::string in_words(const Spread& spread, double unit = 1.0, int decimals = 1);

}  // namespace pendular::reproduction
