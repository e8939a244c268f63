#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/provenance.h"
#include "base/vec3.h"

namespace pendular {

/// One glass bead.
struct Bead {
  std::int64_t id = 0;
  Vec3 centre = Vec3::Zero();   ///< m
  double diameter = 0.0;        ///< m
  double sigma_centre = 0.0;    ///< standard error per axis, m
  double sigma_diameter = 0.0;  ///< m
  double quality = 1.0;         ///< 0 (no evidence) to 1 (perfect fit)
  bool boundary = false;        ///< within one diameter of a wall: out of coordination statistics
};

/// What is known of the polymer between two beads. `candidate`: below the cut-off, polymer not looked for.
enum class BridgeState { candidate, bridge, none, undetermined };

/// The words of bridges.csv; from text, BadInput for any other word.
std::string to_string(BridgeState state);
BridgeState bridge_state(const std::string& word);

/// A pair of neighbouring beads, i < j, as indices into Packing::beads (not ids).
struct Bridge {
  int i = 0, j = 0;
  double gap = 0.0;             ///< surface separation, m; negative: overlap within measurement error
  double sigma_gap = 0.0;       ///< m
  double probability = 1.0;     ///< that polymer joins the two
  double diameter = 0.0;        ///< neck diameter d, m
  double sigma_diameter = 0.0;  ///< m
  BridgeState state = BridgeState::candidate;
};

/// The cylinder that holds the beads; axis along z through (axis_x, axis_y).
struct Specimen {
  double diameter = 0.0;              ///< m
  double height = 0.0;                ///< m
  double axis_x = 0.0, axis_y = 0.0;  ///< m
  double bottom = 0.0;                ///< z of the lower piston's face, m

  double volume() const { return M_PI / 4.0 * diameter * diameter * height; }  ///< m³
};

struct Packing {
  std::vector<Bead> beads;
  std::vector<Bridge> bridges;  ///< sorted by (i, j)
  Specimen specimen;
  Provenance provenance;
};

/// Surface separation of two beads, m.
inline double gap(const Bead& a, const Bead& b) {
  return (a.centre - b.centre).norm() - 0.5 * (a.diameter + b.diameter);
}

}  // namespace pendular
