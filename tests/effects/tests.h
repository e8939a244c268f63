#pragma once

#include <gtest/gtest.h>

#include "dem_core/linear/linear_response.h"
#include "effects/compress.h"
#include "scratch.h"
#include "specimens.h"

namespace pendular::effects::test {

using pendular::test::columns;
using pendular::test::disordered;
using pendular::test::sample_a;
using pendular::test::ScratchFolder;

inline constexpr double kBeadDiameter = 200.9e-6, kGap = 0.03;  // of the columns below, m and over D

/// Nine chains of five bonds between the platens, bead k in chain k % 9, not joined to each other; and the
/// stiffness of one when each bond has this one, N/m.
inline Packing chains() {
  Packing packing = columns(3, 6, kGap);
  std::erase_if(packing.bridges, [](const Bridge& bridge) { return bridge.i % 9 != bridge.j % 9; });
  return packing;
}
inline double chain_stiffness(double kn) {
  return 1.0 / (2.0 / 57600.0 + 5.0 / kn);
}

/// Sample A with one effect; compressed at rest after each increment, to a strain.
inline Sample with(const std::string& effect, double theta, double max_strain = 0.03) {
  Sample sample = sample_a();
  sample.effects[effect] = theta;
  sample.contact.bond_friction_limit = false;
  sample.compression.control = Control::relaxation;
  sample.compression.relax_increment = max_strain / 20.0;
  sample.compression.max_strain = max_strain;
  sample.compression.frames = 0;
  return sample;
}

inline dem_core::CompressResult run(const Packing& packing, const Sample& sample, std::uint64_t seed = 1) {
  ScratchFolder folder;
  return compress_with_effects(packing, sample, seed, folder / "run", {});
}

/// Slope of all rows through the origin, Pa.
inline double secant(const dem_core::CompressResult& run) {
  return run.rows.back().stress / run.rows.back().strain;
}

inline double peak(const dem_core::CompressResult& run) {
  double highest = 0.0;
  for (const auto& row : run.rows) highest = std::max(highest, row.stress);
  return highest;
}

/// Modulus of the specimen as it touches both platens, without a run, Pa.
inline double modulus(const Packing& packing, const Sample& sample, double strain = 0.02) {
  return dem_core::linear_response(actual_simulation(actual_specimen(packing, sample, 1)), {strain}).modulus;
}

inline double work_error(const dem_core::CompressResult& run) {
  return run.result["work_balance"]["relative_error"].get<double>();
}

/// A sample without the effect: the same in all else.
inline Sample without(Sample sample) {
  sample.effects.clear();
  return sample;
}

}  // namespace pendular::effects::test
