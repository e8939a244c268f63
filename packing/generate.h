#pragma once

#include <cstdint>

#include "base/sample.h"
#include "packing/packing.h"

namespace pendular {

/// A dense random packing of beads with diameters N(beads.diameter, beads.diameter_sd) in the sample's
/// cylinder (axis x = y = 0, bottom at z = 0), hard flat wall and pistons. The number of beads follows from
/// specimen.volume_fraction (bead volume over cylinder volume), which is met to within half a bead.
///
/// Random points are grown into the beads by minimising the energy of harmonic soft spheres (O'Hern et al.
/// 2003, PRE 68 011306) with FIRE (Bitzek et al. 2006, PRL 97 170201); where the quench leaves overlaps, the
/// beads are shaken (a short run at a low temperature) and quenched again. No two beads overlap, and none the
/// wall, in the result. Equal for any number of threads. No bridges; boundary flags are set.
///
/// ComputationFailed where the fraction is not reached without overlap: it lies above random close packing
/// (about 0.64 in the bulk, less in a narrow cylinder).
Packing generate_packing(const Sample& sample, std::uint64_t seed);

}  // namespace pendular
