#pragma once

#include <string>
#include <vector>

#include "run_folder/curve.h"
#include "run_folder/events.h"
#include "run_folder/frame.h"
#include "run_folder/result.h"

namespace pendular {

/// The names in a run folder.
namespace run_file {
inline constexpr const char *kCurve = "curve.csv", *kEvents = "events.csv", *kAvalanches = "avalanches.csv",
                            *kResult = "result.json", *kFrames = "frames";
}

/// One simulated compression: its curve, breaks and frames.
struct RunFolder {
  fs::path path;
  std::vector<double> strain, stress;  ///< curve.csv, in the order of loading; stress in Pa
  std::vector<double> break_strain;    ///< strain at each broken bond, rising
  RunResult result;
  std::vector<fs::path> frames;  ///< frames/frame_*.vtp in order
};

/// Reads everything but the frames' content. BadInput where the folder, its curve, its result or its frames
/// are missing, empty or broken. events.csv may be missing.
RunFolder read_run_folder(const fs::path& path);

/// The same of a run that may have kept no frames, as most runs of a sweep.
RunFolder read_run_curves(const fs::path& path);

/// The run folders in `path`: `path` itself, or its subfolders realisation_01, realisation_02 … in order.
std::vector<fs::path> realisations(const fs::path& path);

/// Files of a folder whose names start and end like this, in order; none where there is no folder.
std::vector<fs::path> sorted_entries(const fs::path& folder, const std::string& start,
                                     const std::string& extension);

/// The files in a folder of realisations, or in a run folder, on which its pictures depend.
std::vector<fs::path> picture_inputs(const fs::path& path);

}  // namespace pendular
