#pragma once

#include <vector>

#include "base/vec3.h"

namespace pendular::diagnosis {

/// Displacements of the same beads, as measured and as members of the best simulation's ensemble have them.
/// m; rigid motion and change of scale removed from each.
struct MovedBeads {
  std::vector<Vec3> rest;
  double diameter = 0.0;  ///< mean, of the beads
  std::vector<Vec3> measured;
  double sigma = 0.0;  ///< stated standard error of a component of `measured`
  std::vector<std::vector<Vec3>> members;

  std::size_t size() const { return rest.size(); }
};
std::vector<Vec3> mean_member(const MovedBeads& beads);

/// The square of what a member's component scatters by about the mean, per bead; raised by what the mean is
/// itself uncertain by.
std::vector<double> member_variance(const MovedBeads& beads);

/// How measured fields would depart from the simulation if nothing were amiss: each member in turn less the
/// mean of the others, with noise of the stated size; seeded.
std::vector<std::vector<Vec3>> null_differences(const MovedBeads& beads, int draws);

/// Where experiment and simulation part, bead by bead.
struct PlaceMisfit {
  std::vector<Vec3> difference;  ///< measured less simulated, m
  std::vector<double> value;     ///< of the pairs about a bead, in units of the noise; about 1: nothing amiss
  double threshold =
      0.0;  ///< that one specimen in twenty exceeds anywhere although nothing is amiss; 2 or more
};

/// Displacements carry a flaw's effect far; how neighbours part does not. So of each pair of neighbours the
/// difference of displacement is compared, over its noise (stated errors and the members' scatter of that
/// pair): z², a third of its sum over components. A bead's value is exp⟨ln(1 + z²)⟩ − 1 over the pairs whose
/// middle lies within 1.3 diameters of it, divided by what noise alone gives, square root taken. Of these
/// pairs, those of the one bead that adds most are left out: a single bead that rattles, or whose contact is
/// taken for open or closed wrongly, makes no place.
PlaceMisfit place_misfit(const MovedBeads& beads);

/// The value that maxima of so many seeded cases exceed with this probability, by the Gumbel distribution of
/// their mean and standard deviation.
double exceeded_by(const std::vector<double>& maxima, double probability);

}  // namespace pendular::diagnosis
