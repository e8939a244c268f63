#pragma once

#include <filesystem>
#include <vector>

#include "base/vec3.h"

namespace pendular::test {

/// A made-up run with a shear band at a known place.
struct PlantedRun {
  double bead_diameter = 200e-6;      ///< m
  double specimen_diameter = 2.4e-3;  ///< m
  double specimen_height = 3.2e-3;    ///< m
  double band_angle = 0.75;           ///< between band plane and axis, rad
  double band_azimuth = 0.7;          ///< of the horizontal part of its normal, rad from x
  double band_thickness = 500e-6;     ///< m
  double slip = 300e-6;               ///< along the band at the end, m
  int frames = 4;
  double toe = 0.004;     ///< strain before the linear part
  double modulus = 15e6;  ///< Pa

  Vec3 normal() const;
  Vec3 point() const { return Vec3(0.0, 0.0, 0.5 * specimen_height); }
};

/// Writes curve.csv, events.csv, result.json and frames/ as `pendular compress` does: beads on a jittered
/// lattice in a cylinder; axial strain everywhere and a slip down the dip that is spread over the band's
/// thickness; bonds between neighbours, broken where they cross the middle of the band.
void write_planted_run(const std::filesystem::path& folder, const PlantedRun& planted);

}  // namespace pendular::test
