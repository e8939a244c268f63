#include "diagnosis/experiment/believed.h"

#include "micromechanics/stiffness.h"

namespace pendular::diagnosis {
namespace {

micromechanics::BondStiffness by_finite_elements(Sample sample) {
  sample.bridges.normal_stiffness = sample.bridges.tangential_stiffness = std::nullopt;
  sample.bridges.stiffness = StiffnessOf::one;
  return micromechanics::bond_stiffness(sample);
}

bool same_bridge(const Sample& a, const Sample& b) {
  return a.bridges.youngs_modulus == b.bridges.youngs_modulus &&
         a.bridges.poisson_ratio == b.bridges.poisson_ratio && a.bridges.diameter == b.bridges.diameter &&
         a.bridges.gap == b.bridges.gap && a.beads.diameter == b.beads.diameter;
}

}  // namespace

Sample changed_sample(const Sample& sample, const std::function<void(Sample&)>& change) {
  Sample changed = sample;
  change(changed);
  auto &kn = changed.bridges.normal_stiffness, &kt = changed.bridges.tangential_stiffness;
  const bool stated_alike =
      kn && kn == sample.bridges.normal_stiffness && kt == sample.bridges.tangential_stiffness;
  if (!stated_alike || same_bridge(sample, changed)) return changed;
  const micromechanics::BondStiffness before = by_finite_elements(sample),
                                      after = by_finite_elements(changed);
  *kn *= after.normal / before.normal;
  *kt *= after.tangential / before.tangential;
  return changed;
}

}  // namespace pendular::diagnosis
