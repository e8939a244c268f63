#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "base/files.h"
#include "base/vec3.h"

namespace pendular::viz {

/// The plane along which a specimen shears.
struct ShearBand {
  Vec3 normal = Vec3::UnitZ();  ///< unit length, z component not negative
  Vec3 point = Vec3::Zero();    ///< m
  double thickness = 0.0;       ///< m
  double contrast = 0.0;        ///< mean local shear strain inside over outside

  /// Between the plane and the compression axis, rad, 0 to π/2.
  double angle_to_axis() const;
};

/// What a run says of itself (result.json); what it does not say is empty.
struct RunResult {
  std::optional<double> modulus, modulus_sigma;    ///< Pa
  double toe = 0.0;                                ///< platen strain where the fitted line meets zero stress
  std::optional<double> linear_limit;              ///< strain beyond the toe
  std::optional<double> peak_strain, peak_stress;  ///< beyond the toe; Pa
  std::optional<ShearBand> band;
  std::optional<std::int64_t> beads, bonds;
  std::optional<double> coordination;  ///< bridges per interior bead before loading
  nlohmann::ordered_json provenance;   ///< null where absent
};

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

/// The files in a folder of realisations, or in a run folder, on which its pictures depend.
std::vector<fs::path> picture_inputs(const fs::path& path);

}  // namespace pendular::viz
