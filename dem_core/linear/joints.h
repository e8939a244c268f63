#pragma once

#include <vector>

#include "dem_core/linear/spring_network.h"
#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// A pair, or a bead near a platen, as a linear problem sees it; at no displacement it is as in the
/// simulation. Beads are the network's nodes by their index, the platens the two after them. SI.
struct Joint {
  NetworkSpring place;  ///< nodes, direction, arms; its stiffness is left at zero
  PairProperties law;   ///< without a bond where the joint is at a platen
  PairHistory history;
  double gap = 0.0;
  double distance = 0.0;  ///< between the beads' centres, or from the bead's to the platen
  double friction = 0.0;
  bool bonded() const { return law.kn > 0.0; }
};

/// Whether a joint's glass is closed, the share of a straight way there on which it still was open, and the
/// gap there, m.
struct Closure {
  bool closed = false;
  double open_share = 0.0;
  double gap = 0.0;
};

/// All pairs that are listed, then the beads within `reach` (m) of each platen's face.
std::vector<Joint> joints_of(const Simulation& simulation, double reach);

std::vector<Closure> closures_at(const SpringNetwork& nodes, const std::vector<Joint>& joints,
                                 const NodeVector& x);

/// The nodes of a simulation, with no spring yet.
SpringNetwork nodes_of(const Simulation& simulation);

/// The springs of the joints that are bonded or closed. `secant`: those that give a joint's force where a
/// straight way from no displacement has led to these closures; otherwise those that give its change there.
SpringNetwork network_of(const Simulation& simulation, const std::vector<Joint>& joints,
                         const std::vector<Closure>& closures, bool secant);

/// What the law would do to a joint at displacement x.
struct JointState {
  double normal = 0.0;  ///< N, positive pushes apart
  bool slides = false;  ///< at Coulomb's limit or beyond it
  bool breaks = false;  ///< beyond Griffith's criterion
};
JointState state_at(const Joint& joint, const Closure& closure, const SpringNetwork& nodes,
                    const LawParameters& law, const NodeVector& x);

}  // namespace pendular::dem_core
