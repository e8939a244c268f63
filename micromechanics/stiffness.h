#pragma once

#include "base/sample.h"

namespace pendular {

/// Stiffness of one bond, N/m.
struct BondStiffness {
  double normal = 0.0;
  double tangential = 0.0;
};

/// The stiffness every bond of a sample has (the paper gives all bonds the same): what the sample file
/// states. BadInput where it states none.
BondStiffness bond_stiffness(const Sample& sample);

}  // namespace pendular
