#include "dem_core/law/pair.h"

#include "dem_core/law/pair-inl.h"

namespace pendular::dem_core {

namespace law = HWY_NAMESPACE;
namespace {

GlassLaw<double> glass_law(const LawParameters& parameters) {
  return {parameters.k_glass, per_overlap(parameters), parts(parameters).hertz};
}

}  // namespace

PairForce advance_pair(const BeadMotion& i, const BeadMotion& j, const PairProperties& pair,
                       const LawParameters& parameters, double dt, PairHistory& history) {
  const law::PairMotion<double> motion = {triple(i.position - j.position),
                                          triple(i.velocity - j.velocity),
                                          triple(i.radius * i.spin + j.radius * j.spin),
                                          triple(i.spin + j.spin),
                                          triple(i.spin - j.spin),
                                          i.radius + j.radius};
  const LawNumbers<double> given = numbers(parameters, dt);
  const auto seen = law::approach(motion, given);
  return {law::advance_pair<true>(seen, motion, pair, given, parts(parameters), history), 0.5 * seen.gap};
}

double contact_force(double gap, double touch, const LawParameters& parameters) {
  return law::contact_force(gap, touch, glass_law(parameters));
}

double contact_energy(double gap, double touch, const LawParameters& parameters) {
  return law::contact_energy(gap, touch, glass_law(parameters));
}

double normal_force(double gap, const PairProperties& pair, const LawParameters& parameters) {
  return contact_force(gap, pair.touch, parameters) + law::bond_force(gap, pair, parts(parameters).hertz);
}

double normal_stiffness(double gap, const PairProperties& pair, const LawParameters& parameters) {
  const GlassLaw<double> glass = glass_law(parameters);
  return glass.hertz ? pair.kn + 1.5 * law::glass_secant(pair.touch - gap, glass) : glass.k;
}

bool breaks(double gap, const PairProperties& pair, const PairHistory& history,
            const LawParameters& parameters) {
  return pair.kn > 0.0 && law::breaks(gap, history.bond_slip, pair, parameters.separate_limits);
}

double pair_energy(const Vec3& apart, double radii, const PairProperties& pair, const PairHistory& history,
                   const LawParameters& parameters) {
  const double distance = apart.norm(), gap = distance - radii;
  const double bond_shear = law::dot(history.bond_slip, history.bond_slip);
  const double energy = contact_energy(gap, pair.touch, parameters) +
                        law::bond_energy(gap, pair, parts(parameters).hertz) +
                        law::bending_energy(history.turn, triple(apart / distance), pair);
  if (parameters.one_spring)
    return energy + 0.5 * (gap <= pair.touch ? parameters.kt_glass : pair.kt) * bond_shear;
  return energy + 0.5 * pair.kt * bond_shear +
         0.5 * parameters.kt_glass * law::dot(history.contact_slip, history.contact_slip);
}

double break_bond(const Vec3& apart, double radii, const LawParameters& parameters, PairProperties& pair,
                  PairHistory& history) {
  const double before = pair_energy(apart, radii, pair, history, parameters);
  pair.kn = pair.kt = pair.k_bend = pair.k_twist = 0.0;
  history.turn = {};
  if (!parameters.one_spring || apart.norm() - radii > pair.touch) history.bond_slip = {};
  return before - pair_energy(apart, radii, pair, history, parameters);
}

}  // namespace pendular::dem_core
