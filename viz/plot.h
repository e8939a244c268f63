#pragma once

#include <span>

#include "run_folder/run_folder.h"
#include "viz/figure.h"

namespace pendular::viz {

/// Width in strain of the bins in which broken bonds are counted (Hemmerle et al. 2021, Sec. 3.3).
inline constexpr double kBreakBin = 4.2e-4;

/// Stress (MPa, left axis) over strain (%), with the linear fit, the end of the linear range and the peak of
/// the first run marked, and its broken bonds per bin of kBreakBin on the right axis. Further runs are
/// overlaid as thin lines. At least one run.
Figure stress_strain_figure(std::span<const RunFolder> runs, PictureSize size = {});

}  // namespace pendular::viz
