#include "dem_core/linear/stiffness_sensitivity.h"

namespace pendular::dem_core {
namespace {

/// Calls use(node, force, moment over the radius) with the part of one spring in K x − pushes, for both its
/// nodes.
template <typename Use>
void each_node(const NetworkSpring& s, const SpringNetwork& network, const NodeVector& x, const Use& use) {
  const Vec3 moved = network.relative(s, x);
  const Vec3 force = s.tangential * moved + ((s.normal - s.tangential) * moved.dot(s.n) - s.push) * s.n;
  const Vec3 torque = -s.n.cross(force);
  Vec3 moment = Vec3::Zero();
  if (s.bend != 0.0 || s.twist != 0.0) {
    const Vec3 turned =
        x.segment<3>(6 * s.i + 3) / network.radius(s.i) - x.segment<3>(6 * s.j + 3) / network.radius(s.j);
    moment = s.bend * turned + ((s.twist - s.bend) * turned.dot(s.n)) * s.n;
  }
  use(s.i, force, s.arm_i * torque + moment / network.radius(s.i));
  use(s.j, -force, s.arm_j * torque - moment / network.radius(s.j));
}

}  // namespace

NodeVector stiffness_sensitivity(const SpringNetwork& network, const NodeVector& x,
                                 const std::vector<double>& weights, double tolerance) {
  NodeVector load = NodeVector::Zero(x.size()), change = load;
  const auto& springs = network.springs();
  for (std::size_t b = 0; b < springs.size(); ++b)
    if (weights[b] != 0.0)
      each_node(springs[b], network, x, [&](int node, const Vec3& force, const Vec3& torque) {
        load.segment<3>(6 * node) -= weights[b] * force;
        load.segment<3>(6 * node + 3) -= weights[b] * torque;
      });
  solve(network, load, tolerance, change);
  return change;
}

std::vector<double> stiffness_gradient(const SpringNetwork& network, const NodeVector& x,
                                       const NodeVector& gradient, double tolerance) {
  NodeVector adjoint = NodeVector::Zero(x.size());
  solve(network, gradient, tolerance, adjoint);
  std::vector<double> derivative;
  for (const auto& spring : network.springs()) {
    double sum = 0.0;
    each_node(spring, network, x, [&](int node, const Vec3& force, const Vec3& torque) {
      sum -= adjoint.segment<3>(6 * node).dot(force) + adjoint.segment<3>(6 * node + 3).dot(torque);
    });
    derivative.push_back(sum);
  }
  return derivative;
}

}  // namespace pendular::dem_core
