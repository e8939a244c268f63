#pragma once

#include "dem_core/compress.h"
#include "effects/effect.h"

namespace pendular::effects {

/// The specimen that the sample's effects make of a measured packing, with diameters drawn where the sample
/// asks for it (realise()). The same seed draws the same specimen at any magnitude. BadInput for an unknown
/// effect or a magnitude out of range.
ActualSpecimen actual_specimen(const Packing& measured, const Sample& believed, std::uint64_t seed);

/// What measured beads are taken to be where the sample's effects hold (Effect::beads).
std::vector<Bead> actual_beads(std::vector<Bead> measured, const Sample& believed);

/// What the measurement would report of a packing that is: the inverse of how the measurement of single beads
/// enters actual_specimen().
Packing reading(const Packing& actual, const Sample& believed, std::uint64_t seed);

/// It between its platens, before its test: build_simulation() and the effects on it.
dem_core::Simulation actual_simulation(const ActualSpecimen& specimen);

/// The test of that specimen, as its instruments report it. Without effects bitwise the same as of realise().
dem_core::CompressTask task_with_effects(const Packing& measured, const Sample& believed, std::uint64_t seed,
                                         const fs::path& folder, dem_core::CompressOptions options);

/// compress() of it.
dem_core::CompressResult compress_with_effects(const Packing& measured, const Sample& believed,
                                               std::uint64_t seed, const fs::path& folder,
                                               dem_core::CompressOptions options);

}  // namespace pendular::effects
