#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/sample.h"
#include "micromechanics/bond_stiffness.h"
#include "micromechanics/bridge_body.h"
#include "micromechanics/bridge_fe.h"

namespace pendular::micromechanics {

/// A sample's polymer, and the body of its mean bridge: mean d and D, and the gap for which stiffness holds.
Polymer polymer_of(const Sample& sample);
BridgeBody mean_bridge(const Sample& sample);

/// The stiffness of a sample's mean bridge, which the paper gives to all bonds: kn and kt as the sample file
/// states them or, where it states neither, by finite elements; bending and twisting always by finite
/// elements. BadInput where only one is stated or the mean bridge is none (check_bridge()).
BondStiffness bond_stiffness(const Sample& sample);

/// Stiffness of each of some bridges from its own gap, neck and beads. Gaps below kSmallestGapRatio × D, also
/// negative ones, count as that: the stiffness of a touching pair's bridge would be infinite.
struct BridgeStiffnesses {
  std::vector<BondStiffness> bonds;  ///< one per bridge, in order
  std::size_t raised_gaps = 0;       ///< bridges whose gap was raised
  double interpolation_error = 0.0;  ///< relative, as measured (StiffnessTable::measured_error)
};

/// By interpolation between finite element solutions; in parallel, results independent of threads. 30,000
/// bridges take about a second. BadInput as check_bridge(), gaps aside.
BridgeStiffnesses bridge_stiffnesses(std::span<const BridgeBody> bodies, const Polymer& polymer);

/// The stiffness of each bond of a specimen as the sample asks for it: bond_stiffness() for all of them
/// (bridges.stiffness = "one") or each its own ("per_bridge"), with a warning where the table's measured
/// error passes 0.1 %. BadInput where a sample asks for the latter and states kn or kt.
std::vector<BondStiffness> bond_stiffnesses(const Sample& sample, std::span<const BridgeBody> bodies);

}  // namespace pendular::micromechanics
