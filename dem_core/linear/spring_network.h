#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/vec3.h"

namespace pendular::dem_core {

/// One value per unknown: six per node, its displacement u and its rotation times its radius R θ, both in m.
using NodeVector = Eigen::VectorXd;

/// A spring between two nodes, with the kinematics of pair-inl.h: what it feels is the displacement of i
/// against j at the point in mid-gap, s = u_i − u_j + n × (a_i θ_i + a_j θ_j), and θ_i − θ_j. SI.
struct NetworkSpring {
  int i = 0, j = 0;
  Vec3 n = Vec3::UnitZ();                 ///< from j to i
  double arm_i = 0.0, arm_j = 0.0;        ///< a over R of each node; 0 for one that does not turn
  double normal = 0.0, tangential = 0.0;  ///< stiffness, N/m
  double bend = 0.0, twist = 0.0;         ///< stiffness, N m/rad
  double push = 0.0;  ///< normal force at no displacement, N; positive drives the nodes apart
};

/// Nodes joined by springs: a specimen as a linear structure. The last two nodes are the platens: they are
/// held (or displaced), all others are free.
class SpringNetwork {
 public:
  SpringNetwork(std::vector<double> radius, std::vector<NetworkSpring> springs);

  /// The same nodes, joined by other springs.
  SpringNetwork with(std::vector<NetworkSpring> springs) const { return {radius_, std::move(springs)}; }

  int nodes() const { return static_cast<int>(radius_.size()); }
  int free_nodes() const { return nodes() - 2; }
  int bottom() const { return nodes() - 2; }
  int top() const { return nodes() - 1; }
  const std::vector<NetworkSpring>& springs() const { return springs_; }
  double radius(int node) const { return radius_[static_cast<std::size_t>(node)]; }  ///< m

  /// Displacement of i against j at the spring's point, m.
  Vec3 relative(const NetworkSpring& spring, const NodeVector& x) const;

  /// K x, over all nodes: minus the forces of the springs, N (moments over the radius).
  void multiply(const NodeVector& x, NodeVector& out) const;

  /// The forces of the springs' pushes.
  NodeVector pushes() const;

  /// The 6 × 6 blocks on the diagonal of K, one per node.
  std::vector<Eigen::Matrix<double, 6, 6>> diagonal_blocks() const;

  /// Whether springs lead from platen to platen.
  bool spans() const;

 private:
  /// A spring as one of its nodes sees it, with n towards that node: the same law from either side.
  struct End {
    int other, spring;
    Vec3 n;
    double arm, other_arm, normal, tangential;
  };
  std::vector<double> radius_;
  std::vector<NetworkSpring> springs_;
  std::vector<int> first_end_;  ///< node → its first place in ends_
  std::vector<End> ends_;       ///< node by node
  bool bending_ = false;
};

/// Solves K x = load on the free nodes, the others of x held as given; x is also the first guess. Conjugate
/// gradients, preconditioned by the nodes' own blocks: bitwise the same for any number of threads. Where part
/// of the network is a mechanism K is singular; the load never works on one (springs alone carry it), so the
/// method converges as it does otherwise and leaves mechanisms where the guess had them.
struct Solution {
  int iterations = 0;
  double residual = 0.0;  ///< of the free nodes, over the load
};
/// ComputationFailed where the residual does not fall to `tolerance`.
Solution solve(const SpringNetwork& network, const NodeVector& load, double tolerance, NodeVector& x);

}  // namespace pendular::dem_core
