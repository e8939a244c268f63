#include "micromechanics/stiffness.h"

#include "base/error.h"

namespace pendular {

BondStiffness bond_stiffness(const Sample& sample) {
  if (!sample.bridges.normal_stiffness || !sample.bridges.tangential_stiffness)
    bad_input(
        "sample: bridges.normal_stiffness_n_per_m and bridges.tangential_stiffness_n_per_m: found none, "
        "expected both "
        "(N/m)");
  return {*sample.bridges.normal_stiffness, *sample.bridges.tangential_stiffness};
}

}  // namespace pendular
