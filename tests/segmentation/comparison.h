#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/sample.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "packing/packing.h"
#include "phantom/phantom.h"

namespace pendular::test {

/// Measured against true beads, lengths in voxels.
struct Comparison {
  int missed = 0, invented = 0;
  double centre_rms = 0.0;  ///< per axis
  double diameter_bias = 0.0;
  double pull = 0.0;  ///< rms error of the centres over their standard error
};

inline Comparison compare(const std::vector<Bead>& truth, const std::vector<Bead>& found, double voxel) {
  Comparison result;
  std::vector<bool> used(found.size(), false);
  double n = 0.0, squares = 0.0, difference = 0.0, pulls = 0.0;
  for (const Bead& bead : truth) {
    const auto nearest = std::min_element(found.begin(), found.end(), [&](const Bead& a, const Bead& b) {
      return (a.centre - bead.centre).squaredNorm() < (b.centre - bead.centre).squaredNorm();
    });
    const double error = nearest == found.end() ? bead.diameter : (nearest->centre - bead.centre).norm();
    if (error > 0.25 * bead.diameter) {
      ++result.missed;
      continue;
    }
    used[static_cast<std::size_t>(nearest - found.begin())] = true;
    n += 1.0;
    squares += error * error / 3.0;
    pulls += error * error / 3.0 / (nearest->sigma_centre * nearest->sigma_centre);
    difference += nearest->diameter - bead.diameter;
  }
  result.invented = static_cast<int>(std::count(used.begin(), used.end(), false));
  result.centre_rms = std::sqrt(squares / n) / voxel;
  result.diameter_bias = difference / n / voxel;
  result.pull = std::sqrt(pulls / n);
  return result;
}

inline Sample small_sample() {
  Sample sample;
  sample.specimen.diameter = sample.specimen.height = 1.2e-3;
  sample.specimen.volume_fraction = 0.52;
  return sample;
}

/// Beads and bridges with polymer, the same for every case.
inline const Packing& small_packing() {
  static const Packing made = [] {
    const Sample sample = small_sample();
    Packing packing = generate_packing(sample, 1);
    packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * mean_diameter(packing.beads));
    phantom::draw_neck_diameters(packing, sample, 1);
    return packing;
  }();
  return made;
}

}  // namespace pendular::test
