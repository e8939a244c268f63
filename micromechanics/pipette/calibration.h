#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/files.h"
#include "pipette/grey_image.h"

namespace pendular::pipette {

enum class Direction { normal, tangential };

/// What must be known of a micropipette test beside its images; one TOML file (docs/pipette.md lists its
/// keys). SI units but for positions in the image, which are in pixels. Sigmas are standard deviations.
struct Calibration {
  double metres_per_pixel = 0.0, metres_per_pixel_sigma = 0.0;
  double frame_rate = 0.0;                                        ///< 1/s
  double pipette_stiffness = 0.0, pipette_stiffness_sigma = 0.0;  ///< k_p, N/m
  double sigma_reliability = 0.25;  ///< relative uncertainty of pipette_stiffness_sigma itself (GUM, G.4.2)
  double stage_speed = 0.0;         ///< of the wafer, m/s
  Direction direction = Direction::normal;
  Point pull = {1.0, 0.0};  ///< unit vector: where the stage takes the wafer while loading
  std::optional<Region> bead_fixed, bead_free;  ///< both or, where the beads are to be found, neither
  std::optional<Region> pipette;                ///< without: the free bead, glued to it, is its tip
  Region reference;                             ///< rests while the camera drifts
  double expected_diameter = 365e-6;            ///< of the beads, m; for finding them
  int search_reach = 12;                        ///< greatest motion between two frames, pixels
  double least_score = 0.7;                     ///< a worse match is rejected
};

/// Reads and checks a calibration file. BadInput names file, line, key, what was found and what was expected;
/// an unknown key names the nearest known one; a value without its sigma is an error.
Calibration read_calibration(const fs::path& path);

/// The same from text; `name` stands for the file in messages.
Calibration parse_calibration(std::string_view text, const std::string& name);

/// The text of a file that reads back as the same calibration.
std::string to_toml(const Calibration& calibration);

}  // namespace pendular::pipette
