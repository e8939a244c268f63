#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "packing/packing.h"

namespace pendular {

/// Mean number of bridges per bead, over the beads that are not `boundary`.
struct Coordination {
  double mean = 0.0;            ///< NaN where every bead is at a boundary
  double standard_error = 0.0;  ///< spread among beads over √(number of beads)
  std::size_t beads = 0;
};

/// Counts the bridges in state bridge or candidate. A bridge to a boundary bead counts for its interior end.
Coordination coordination(const std::vector<Bead>& beads, const std::vector<Bridge>& bridges);

/// Share of the cylinder's volume that lies in beads: the part of each bead inside it, by Simpson's rule over
/// lens areas along the axis (exact for a bead cut by a flat end only).
double volume_fraction_within(const std::vector<Bead>& beads, const Specimen& cylinder);

/// The specimen less `margin` (m) on every side.
Specimen core_of(const Specimen& specimen, double margin);

/// Sets `boundary` of every bead whose centre lies within one mean diameter of the cylinder wall or of a
/// piston; flags that are set already stay.
void flag_boundary(Packing& packing);

/// The cylinder that beads measured without one fill: sizes as given (m), axis through the middle of the
/// beads' lateral extent, bottom at the lowest bead's lowest point.
Specimen specimen_around(const std::vector<Bead>& beads, double diameter, double height);

/// The same with the smallest sizes that hold every bead.
Specimen specimen_enclosing(const std::vector<Bead>& beads);

struct PackingStatistics {
  std::size_t beads = 0, bridges = 0;
  double mean_diameter = 0.0, diameter_sd = 0.0;  ///< m
  double cutoff = 0.0;                            ///< m
  Coordination coordination;                      ///< of the packing's own bridges
  double volume_fraction = 0.0;                   ///< all beads over the whole cylinder
  double core_volume_fraction = 0.0;  ///< one and a half mean diameters away from walls and pistons
  double touching_share = 0.0;        ///< of pairs below the cut-off: those that touch (touching.h)

  struct CurvePoint {
    double cutoff, coordination;  ///< m; neighbours per interior bead with gaps below it
  };
  std::vector<CurvePoint> coordination_curve;

  /// Gaps of pairs with an interior bead; bin k spans first_edge + k·width to first_edge + (k+1)·width.
  struct Histogram {
    double first_edge = 0.0, width = 0.0;  ///< m
    std::vector<std::size_t> counts;
  } gaps;
};

/// `cutoff` in m. The curve and the histogram reach to 0.25 D.
PackingStatistics packing_statistics(const Packing& packing, double cutoff);

/// Lengths in µm, as the keys say.
nlohmann::ordered_json to_json(const PackingStatistics& statistics);

}  // namespace pendular
