#include "packing/check.h"

#include <algorithm>
#include <unordered_set>

#include "base/columns.h"
#include "base/error.h"
#include "packing/bridges.h"
#include "packing/neighbours.h"

namespace pendular {

void check_beads(const std::vector<Bead>& beads, const std::string& where) {
  if (beads.empty()) bad_input("{}: found no bead, expected at least one", where);
  std::unordered_set<std::int64_t> ids;
  for (const auto& bead : beads) {
    if (!ids.insert(bead.id).second)
      bad_input("{}: bead {}: found the id twice, expected once", where, bead.id);
    const std::string of = fmt::format("bead {}: ", bead.id);
    for (const double x : bead.centre) require_in_range(where, of + "centre, um", range_of("x_um"), 1e6 * x);
    require_in_range(where, of + "diameter, um", range_of("diameter_um"), 1e6 * bead.diameter);
  }
  // Spheres of half the size touch where the centres are half the mean diameter apart.
  std::vector<double> halves = diameters_of(beads);
  for (double& half : halves) half *= 0.5;
  const auto overlaps = pairs_within(centres_of(beads), halves, 0.0);
  if (overlaps.empty()) return;
  const Bead& a = beads[static_cast<std::size_t>(overlaps.front().first)];
  const Bead& b = beads[static_cast<std::size_t>(overlaps.front().second)];
  bad_input(
      "{}: beads {} and {}: found centres {:.6g} um apart with diameters {:.6g} and {:.6g} um, expected "
      "beads beside "
      "each other (one listed twice, or a wrong unit?)",
      where, a.id, b.id, 1e6 * (a.centre - b.centre).norm(), 1e6 * a.diameter, 1e6 * b.diameter);
}

void check_overlaps(const std::vector<Bead>& beads, const std::string& where) {
  for (const auto& pair : candidate_bridges(beads, 0.0)) {
    const Bead &a = beads[static_cast<std::size_t>(pair.i)], &b = beads[static_cast<std::size_t>(pair.j)];
    const double bound = std::max(0.05 * 0.5 * (a.diameter + b.diameter), 5.0 * pair.sigma_gap);
    if (-pair.gap > bound)
      bad_input(
          "{}: beads {} and {}: found an overlap of {:.4g} um, expected at most {:.4g} um (5 % of the "
          "diameter, or five standard errors): measurement does not explain it",
          where, a.id, b.id, -1e6 * pair.gap, 1e6 * bound);
  }
}

}  // namespace pendular
