#include "dem_core/linear/joints.h"

#include <algorithm>
#include <cmath>

namespace pendular::dem_core {
namespace {

Joint pair_joint(const Simulation& s, const Pair& pair) {
  const Vec3 way = apart(s, pair);
  const double ri = s.beads.radius[pair.i], rj = s.beads.radius[pair.j];
  Joint joint;
  joint.distance = way.norm();
  joint.gap = joint.distance - ri - rj;
  joint.place.i = pair.i;
  joint.place.j = pair.j;
  joint.place.n = way / joint.distance;
  joint.place.arm_i = 1.0 + 0.5 * joint.gap / ri;
  joint.place.arm_j = 1.0 + 0.5 * joint.gap / rj;
  joint.law = pair.properties;
  joint.history = pair.history;
  joint.friction = s.law.friction;
  return joint;
}

Joint platen_joint(const Simulation& s, const Platen& platen, int node, std::size_t bead) {
  const double radius = s.beads.radius[bead];
  Joint joint;
  joint.gap = platen.gap(bead, s.beads.position[bead].z(), radius);
  joint.distance = joint.gap + radius;
  joint.place.i = static_cast<int>(bead);
  joint.place.j = node;
  joint.place.n = Vec3(0.0, 0.0, platen.normal_sign);
  joint.place.arm_i = 1.0 + 0.5 * std::min(joint.gap, 0.0) / radius;
  joint.history.contact_slip = triple(platen.slip[bead]);
  joint.friction = s.law.platen_friction;
  return joint;
}

/// `glass_shear`: the share of the glass's tangential spring that counts.
NetworkSpring spring_of(const Joint& joint, const LawParameters& law, const Closure& closure,
                        double glass_shear) {
  NetworkSpring spring = joint.place;
  const PairProperties& pair = joint.law;
  spring.tangential = pair.kt;
  spring.bend = pair.k_bend;
  spring.twist = pair.k_twist;
  if (!closure.closed) {
    spring.normal = pair.kn;
    spring.push = pair.kn * (pair.rest - joint.gap);
    return spring;
  }
  // The law's tangent at the gap where the joint is closed, which for linear glass is the law itself.
  spring.normal = normal_stiffness(closure.gap, pair, law);
  spring.push = normal_force(closure.gap, pair, law) + spring.normal * (closure.gap - joint.gap);
  if (law.one_spring)
    spring.tangential = law.kt_glass;
  else
    spring.tangential += glass_shear * law.kt_glass;
  return spring;
}

Closure closure_of(const Joint& joint, double opening) {
  const double gap = joint.gap + opening, touch = joint.law.touch;
  if (gap > touch) return {};
  return {true, joint.gap > touch ? (joint.gap - touch) / -opening : 0.0, gap};
}

}  // namespace

std::vector<Joint> joints_of(const Simulation& s, double reach) {
  std::vector<Joint> joints;
  joints.reserve(s.pairs.size() + s.beads.size() / 8);
  for (const auto& pair : s.pairs) joints.push_back(pair_joint(s, pair));
  const int beads = static_cast<int>(s.beads.size());
  for (const auto& [platen, node] : {std::pair(&s.bottom, beads), std::pair(&s.top, beads + 1)})
    for (std::size_t k = 0; k < s.beads.size(); ++k) {
      const Joint joint = platen_joint(s, *platen, node, k);
      if (joint.gap <= reach) joints.push_back(joint);
    }
  return joints;
}

std::vector<Closure> closures_at(const SpringNetwork& nodes, const std::vector<Joint>& joints,
                                 const NodeVector& x) {
  std::vector<Closure> closures;
  closures.reserve(joints.size());
  for (const auto& joint : joints)
    closures.push_back(closure_of(joint, nodes.relative(joint.place, x).dot(joint.place.n)));
  return closures;
}

SpringNetwork nodes_of(const Simulation& simulation) {
  std::vector<double> radius = simulation.beads.radius;
  radius.resize(radius.size() + 2, 1.0);  // platens do not turn: any radius will do
  return SpringNetwork(std::move(radius), {});
}

SpringNetwork network_of(const Simulation& s, const std::vector<Joint>& joints,
                         const std::vector<Closure>& closures, bool secant) {
  std::vector<NetworkSpring> springs;
  springs.reserve(joints.size());
  for (std::size_t k = 0; k < joints.size(); ++k)
    if (closures[k].closed || joints[k].bonded())
      springs.push_back(
          spring_of(joints[k], s.law, closures[k], secant ? 1.0 - closures[k].open_share : 1.0));
  return nodes_of(s).with(std::move(springs));
}

JointState state_at(const Joint& joint, const Closure& closure, const SpringNetwork& nodes,
                    const LawParameters& law, const NodeVector& x) {
  const Vec3 moved = nodes.relative(joint.place, x);
  const double opening = moved.dot(joint.place.n), gap = joint.gap + opening;
  const Vec3 sheared = moved - opening * joint.place.n;
  const Vec3 bond_slip = vec3(joint.history.bond_slip) + sheared;
  const Vec3 contact_slip = vec3(joint.history.contact_slip) + (1.0 - closure.open_share) * sheared;
  JointState state;
  state.normal = normal_force(gap, joint.law, law);
  // What slides in a run stands at its limit, to rounding.
  const auto at_limit = [&](double shear_force, double normal) {
    return shear_force > 0.0 && shear_force >= joint.friction * std::fabs(normal) * (1.0 - 1e-9);
  };
  if (law.one_spring) {
    const double k = closure.closed ? law.kt_glass : joint.law.kt;
    state.slides =
        (closure.closed || law.bond_friction_limit) && at_limit(k * bond_slip.norm(), state.normal);
  } else {
    const double glass = contact_force(gap, joint.law.touch, law);
    state.slides = (closure.closed && at_limit(law.kt_glass * contact_slip.norm(), glass)) ||
                   (law.bond_friction_limit && at_limit(joint.law.kt * bond_slip.norm(), state.normal));
  }
  PairHistory history;
  history.bond_slip = triple(bond_slip);
  state.breaks = breaks(gap, joint.law, history, law);
  return state;
}

}  // namespace pendular::dem_core
