#pragma once

#include <vector>

#include "blind/plan.h"
#include "dem_core/curve.h"
#include "micromechanics/bridge_body.h"
#include "packing/packing.h"

namespace pendular::blind {

/// Beads of a specimen as they are, with the pairs below the cut-off as candidates; and as the tomogram shows
/// them: with errors of the stated size. Functions of the seed and of what is believed of the specimen alone,
/// so that all cases on it have the same.
Packing true_beads(const Sample& believed, std::uint64_t seed, const Split& split);
std::vector<Bead> measured_beads(const Packing& actual, std::uint64_t seed, const Split& split);

/// The sample that is true of a case where this one is believed: with its offsets, its law and its effects.
Sample true_sample(const CasePlan& plan, const Split& split, Sample believed);

/// A specimen that was tested, and what its instruments read, before noise.
struct TrueTest {
  Sample sample;
  Packing packing;                 ///< that carried the load
  std::vector<BridgeBody> bodies;  ///< of its standing bridges
  std::vector<CurveRow> rows;      ///< strain and stress as read, not beyond the test's last strain
};

/// Compresses a specimen with all that is withheld, by the simulation itself; `number` tells a case's
/// specimens apart. Tests end, and unload once where asked, at strains as the instruments read them.
/// `scratch` is a folder for the runs, which is removed.
TrueTest run_truth(const CasePlan& plan, const Split& split, const Sample& believed, const Packing& beads,
                   std::uint64_t number, bool unload, const fs::path& scratch);

}  // namespace pendular::blind
