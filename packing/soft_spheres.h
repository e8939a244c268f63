#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.h"

namespace pendular {

/// An upright cylinder, axis x = y = 0, bottom z = 0.
struct Cylinder {
  double radius, height;
};

/// Spheres of unit mass that repel each other and the wall of a cylinder with the overlap (stiffness 1): the
/// means by which generate_packing() finds a packing. Lengths in mean diameters. Internal to packing.
class SoftSpheres {
 public:
  SoftSpheres(const Cylinder& cylinder, std::vector<Vec3> centres, std::vector<double> diameters);

  /// Minimises the energy from rest by at most `steps` steps of FIRE, until no overlap is deeper than
  /// `tolerance`. Returns the deepest overlap.
  double quench(int steps, double tolerance);

  /// Lets the spheres fly for `steps` steps from random velocities of standard deviation `speed` per axis.
  void shake(int steps, double speed, std::uint64_t seed);

  const std::vector<Vec3>& centres() const { return centres_; }

 private:
  void update_neighbours();
  double update_forces();  ///< returns the deepest overlap
  void move(double time_step);

  Cylinder cylinder_;
  std::vector<Vec3> centres_, velocities_, forces_, listed_at_;
  std::vector<double> diameters_;
  std::vector<std::size_t> first_neighbour_;
  std::vector<int> neighbours_;
};

}  // namespace pendular
