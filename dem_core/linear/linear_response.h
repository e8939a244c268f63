#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dem_core/linear/spring_network.h"
#include "dem_core/simulation.h"

namespace pendular::dem_core {

struct LinearResponseOptions {
  /// Platen strain from first touch for which the closed contacts are found; nothing: the contacts are those
  /// of the simulation as it is now.
  std::optional<double> strain;
  int most_rounds = 20;  ///< of the search for the closed contacts
};

/// How many of the specimen's pairs and platen contacts do what.
struct ContactCount {
  int bonds = 0;            ///< that stand
  int touching = 0;         ///< pairs whose glass touches, bonded or not
  int bottom = 0, top = 0;  ///< beads on the platens
  int sliding = 0;          ///< bonds and contacts at Coulomb's limit or beyond it
  int breaking = 0;         ///< bonds beyond Griffith's criterion
  int closed() const { return touching + bottom + top; }
};

/// The specimen as a linear structure between its platens. SI.
struct LinearResponse {
  double modulus = 0.0;        ///< change of axial stress over change of strain, Pa
  double poisson_ratio = 0.0;  ///< change of lateral strain (lateral_strain.h) over change of strain
  double stress = 0.0;         ///< at the strain asked for, Pa; 0 for the contacts as they are
  ContactCount contacts;
  int rounds = 0;         ///< of the search for the closed contacts
  int unsettled = 0;      ///< contacts that opened or closed in its last round
  int iterations = 0;     ///< of the linear solver, all in all
  double residual = 0.0;  ///< of the equations of the modulus, over their load

  /// Relative change of the modulus to first order, where sliding contacts lose their tangential spring, and
  /// where the forces already carried turn along with their pairs (geometric stiffness).
  double sliding_effect = 0.0, load_effect = 0.0;

  /// Why the DEM's modulus may differ, in words.
  std::vector<std::string> reasons;
  bool holds() const { return reasons.empty(); }
};

/// Stiffness of the bonded network between the platens, the top one fixed, the bottom one moved along z.
/// Beads on a platen stick to it; bonds and touching glass are springs with the stiffness and the kinematics
/// of the DEM's law (laws-inl.h, pair-inl.h). Contacts stay as they are, no force carried from before acts.
///
/// With a strain, `simulation` is a specimen before its test, and the contacts closed at that strain are
/// found first: pairs follow their law through touch, each on a straight way, until no contact opens or
/// closes any more (or nearly none: `unsettled`). docs/linear_response.md has the equations and what they
/// leave out.
///
/// Bitwise the same for any number of threads. ComputationFailed where no springs lead from platen to platen;
/// Interrupted where the user asks for it.
LinearResponse linear_response(const Simulation& simulation, const LinearResponseOptions& options = {});

/// The springs of a simulation's bonds and contacts as they are now.
SpringNetwork spring_network(const Simulation& simulation);

}  // namespace pendular::dem_core
