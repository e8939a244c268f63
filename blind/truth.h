#pragma once

#include <set>
#include <vector>

#include "blind/plan.h"
#include "dem_core/observe/curve.h"
#include "micromechanics/bridge_body.h"
#include "packing/packing.h"

namespace pendular::blind {

/// Beads of a specimen as a tomogram without noise reports them, with the pairs truly below the cut-off as
/// candidates: those of a packing whose beads touch, but for what the case's effects do to their measurement.
/// Where these do nothing, a function of the seed and of what is believed of the specimen alone, so that all
/// such cases on it have the same beads.
Packing reported_beads(const CasePlan& plan, const Split& split, const Sample& believed, std::uint64_t seed,
                       std::uint64_t number);

/// With errors of the stated size.
std::vector<Bead> measured_beads(const Packing& reported, std::uint64_t seed, const Split& split);

/// The sample that is true of a case where this one is believed: with its offsets, its law and its effects.
Sample true_sample(const CasePlan& plan, const Split& split, const Sample& believed);

/// A specimen under load, in the order of its beads and bridges.
struct Scan {
  std::vector<Vec3> displacement;          ///< of the beads since rest, m
  std::set<std::pair<int, int>> standing;  ///< pairs of beads that bridges join
};

/// A specimen that was tested, and what its instruments read, before noise.
struct TrueTest {
  Sample sample;
  Packing packing;                                 ///< that carried the load
  std::vector<micromechanics::BridgeBody> bodies;  ///< of its standing bridges
  std::vector<CurveRow> rows;  ///< strain and stress as read, not beyond the test's last strain
  std::string engine;          ///< that made it, with its version; empty: as the diagnosis does
  Scan scan;                   ///< where the strain that is read is the scan's; empty: none was made
};

/// Compresses a specimen, given as reported, with all that is withheld, by the simulation itself; `number`
/// tells a case's specimens apart. Tests end, and unload once where asked, at strains as the instruments read
/// them. `scratch` is a folder for the runs, which is removed. Where `scan_at` is positive the specimen is
/// scanned at that strain, as it is read, on its first loading.
TrueTest run_truth(const CasePlan& plan, const Split& split, const Sample& believed, const Packing& beads,
                   std::uint64_t number, bool unload, double scan_at, const fs::path& scratch);

}  // namespace pendular::blind
