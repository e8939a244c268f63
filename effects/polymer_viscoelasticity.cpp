#include <cmath>

#include "effects/effect.h"

namespace pendular::effects {
namespace {

constexpr double kRelaxationStrain = 0.01;  // of the platen, at the stated speed

/// Standard linear solid: of a bond's stiffness, the share θ follows a strain that creeps after the bond's
/// with the relaxation time. The memory is that strain: normal, then tangential, in m. What the spring holds
/// is the bond's strain less θ times the memory.
struct Creep {
  double theta, time;

  void operator()(const dem_core::BondMoment& bond) const {
    const double share = -std::expm1(-bond.elapsed / time);
    double& normal = bond.memory[0];
    const double moved = share * (bond.stretch - (1.0 - theta) * normal);
    normal += moved;
    bond.properties.rest += theta * moved;
    Vec3 crept(bond.memory[1], bond.memory[2], bond.memory[3]);
    const Vec3 slip = vec3(bond.history.bond_slip);
    crept -= crept.dot(bond.normal) * bond.normal;  // the contact plane has turned
    const Vec3 slid = share * (slip - (1.0 - theta) * crept);
    crept += slid;
    bond.history.bond_slip = dem_core::triple(slip - theta * slid);
    for (int axis = 0; axis < 3; ++axis) bond.memory[1 + axis] = crept[axis];
  }
};

std::function<void(const dem_core::BondMoment&)> evolution(const ActualSpecimen& specimen, double theta) {
  const Sample& stated = specimen.believed;
  return Creep{theta, stated.bridges.relaxation_time.value_or(kRelaxationStrain * stated.specimen.height /
                                                              dem_core::platen_speed(stated))};
}

}  // namespace

/// The paper's polymer is elastic. A real one relaxes: the share θ of each bridge's stiffness decays, in
/// bridges.relaxation_time_s or, where that is not stated, in the time in which a platen at the stated speed
/// strains the specimen by 1 %; the instantaneous stiffness is the
/// stated one. Bending and twisting do not relax. The criterion of breaking sees the strain that the springs
/// still hold. Lowers E and makes it depend on the speed; loops open.
Effect polymer_viscoelasticity() {
  return {.id = "polymer_viscoelasticity",
          .unit = "fraction",
          .name = "polymer that relaxes",
          .sentence = "Part of each bridge's stiffness relaxes with time.",
          .meaning = "share of the stiffness that relaxes",
          .lowest = 0.0,
          .highest = 0.95,
          .bank_from = 0.0,
          .bank_to = 0.6,
          .evolution = evolution,
          .memory = 4};
}

}  // namespace pendular::effects
