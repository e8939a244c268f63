#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "pipette/calibration.h"
#include "pipette/grey_image.h"

namespace pendular::pipette {

/// A made-up micropipette test with known truth: two textured beads, the bridge between them, the pipette on
/// the free one, the wafer on the fixed one, and dirt that rests. Pixels and grey values over full scale.
struct Phantom {
  int width = 220, height = 130;
  Direction direction = Direction::normal;
  double bead_diameter = 64.0, neck_diameter = 26.0;
  int still = 3, loading = 30, unloading = 27;    ///< frames
  double blur = 1.0;                              ///< sd of the point spread
  double read_noise = 0.008, shot_noise = 0.012;  ///< sd; that of shot noise at white, grows as √grey
  double drift = 0.8;                             ///< of the camera over the test, both axes
  double light = 0.06;                            ///< relative change of the light over the test
  std::optional<int> dropped;                     ///< a frame that comes out black
  int bits = 8;
  std::uint64_t seed = 1;

  double um_per_pixel = 1.37, frame_rate = 10.0;              ///< true ones
  double pipette_stiffness = 40.0, bridge_stiffness = 400.0;  ///< true ones, N/m
  double stage_travel = 28.0;                                 ///< pixels
  double softening = 0.0;  ///< share of the stiffness lost at the greatest extension; 0: linear
  double texture = 0.10;   ///< sd-like amplitude of the beads' speckles
};

/// True displacements of a frame in pixels along the direction of pulling, without drift, and the drift.
struct PhantomMotion {
  double wafer = 0.0, pipette = 0.0;
  Point drift = Point::Zero();
};

int frames_of(const Phantom& phantom);

/// Quasi-static equilibrium: k_p × pipette = F(wafer − pipette).
PhantomMotion phantom_motion(const Phantom& phantom, int frame);

/// One frame, drawn at the exact sub-pixel positions: every edge and speckle is a closed form already blurred
/// by the point spread and the pixel, evaluated where it has moved to. No image is resampled.
GreyImage phantom_frame(const Phantom& phantom, int frame);

/// A calibration whose values are the true ones, with the regions of the phantom. The stated uncertainties
/// are 5 % of the pipette's stiffness and 1 % of the scale.
Calibration phantom_calibration(const Phantom& phantom);

/// Writes frame_0000.png … into a folder that is there, with 8 or 16 bits.
void write_phantom(const fs::path& folder, const Phantom& phantom);

}  // namespace pendular::pipette
