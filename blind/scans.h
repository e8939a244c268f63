#pragma once

#include <nlohmann/json_fwd.hpp>

#include <set>
#include <utility>
#include <vector>

#include "blind/instruments.h"

namespace pendular::blind {

/// What two scans of specimen A report.
struct ScannedSpecimen {
  const CasePlan& plan;
  const Split& split;
  const Packing& reported;            ///< beads at rest as a scan without noise reports them
  const std::vector<Bead>& measured;  ///< as the first scan does
  const TrueTest& test;
};

/// The beads' displacements between the scans, as an observation of kind `displacements` has them. The second
/// scan has errors of its own, of the split's sigma_centre. Between the scans the specimen was shifted,
/// turned by any angle about its axis and a few degrees about others, and the voxel size drifted by up to 0.5
/// %. One bead in a hundred is lost. `strain`: the platen's, as it was read. `told`: what was done.
Table followed_beads(const ScannedSpecimen& specimen, double strain, nlohmann::ordered_json& told);

/// The pairs of beads that bridges join at rest.
std::set<std::pair<int, int>> bridges_at_rest(const TrueTest& test);

/// The candidate pairs of a scan as `pendular segment` reports them, `standing` those that bridges join in
/// it: one in fifty undetermined, one in two hundred mistaken, necks known to 2 %; stated sigmas off by up to
/// 30 %. `name` tells scans apart.
std::vector<Bridge> measured_bridges(const ScannedSpecimen& specimen, const std::string& name,
                                     const std::set<std::pair<int, int>>& standing,
                                     nlohmann::ordered_json& told);

}  // namespace pendular::blind
