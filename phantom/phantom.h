#pragma once

#include <cstdint>

#include "base/sample.h"
#include "packing/packing.h"
#include "volume/volume.h"

namespace pendular::phantom {

/// Turns every candidate of the packing into a bridge and gives every bridge that has none a neck diameter
/// drawn from N(bridges.diameter, bridges.diameter_sd), truncated to [0.2, 0.9] of the smaller bead.
/// Bridges of state `none` and `undetermined` stay as they are.
void draw_neck_diameters(Packing& packing, const Sample& sample, std::uint64_t seed);

/// A synthetic tomogram of the packing in its container: 8 or 16 bit unsigned voxels whose grey value is
///   g = G (air + (glass − air) v), rounded and clipped to [0, G], G the largest value of the type,
///   v = b(ϱ) (psf ⊗ m) + rings + white noise + correlated noise.
/// - m is the share of the voxel filled by glass + polymer_contrast × polymer + wall_contrast × wall +
///   piston_contrast × piston; where bodies overlap the first named has the place. Polymer is, for
///   every bridge of state `bridge` or `candidate` with a neck diameter, the cylinder of that diameter
///   between the two beads less both beads. The wall is a tube over the volume's whole height whose inner
///   surface is the specimen's; the pistons fill it above and below the specimen.
/// - psf is a Gaussian of sd blur_voxels, on top of the average over the voxel.
/// - b = 1 − beam_hardening (1 − (ϱ/ϱc)²) at distance ϱ from the specimen's axis, up to ϱc, the container's
///   outer radius; 1 beyond.
/// - rings: every ring of one voxel's width about the volume's vertical axis has one normal amplitude of sd
///   `rings`, the same in every slice.
/// - white noise has sd `noise`; correlated noise has sd `correlated_noise` and is white noise smoothed by a
///   Gaussian of sd correlation_voxels, so that its correlation at a distance of t voxels is
///   exp(−t²/(4 correlation_voxels²)).
/// The volume is the container with `margin` of air around it and of piston above and below the specimen,
/// centred on the specimen. A function of its arguments alone, whatever the number of threads.
/// BadInput where a bead has no size or a neck is no thinner than its beads; ComputationFailed where the
/// volume would not fit into memory.
Volume make_phantom(const Packing& packing, const Sample::Phantom& settings, std::uint64_t seed);

}  // namespace pendular::phantom
