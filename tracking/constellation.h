#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "packing/packing.h"

namespace pendular::tracking {

/// Two beads, one of each scan, whose surroundings look alike in some orientation.
struct Anchor {
  int before = -1, after = -1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< of the second scan's surroundings; proper
  double score = 0.0;                      ///< share of neighbours within 2.5 mean diameters found again
  std::vector<std::pair<int, int>> pairs;  ///< these neighbours in the first and the second scan, and the two
};

/// Beads' surroundings in two scans that may be turned against each other by any angle.
///
/// Two near neighbours of a bead span a triangle with it. Triangles of like sides and diameters about a bead
/// of the other scan give a rotation each; those that bring most of the near neighbours onto beads are
/// refined to a linear map, in shells of 1.5, 2 and 2.5 mean diameters, and scored by the neighbours found
/// within a quarter of a diameter of their places. Sides may differ by 15 % of a diameter and maps be linear,
/// so that specimens may be strained by some 10 % between the scans.
class Constellations {
 public:
  /// Diameters are compared after the second scan's are scaled to the first's mean.
  Constellations(const std::vector<Bead>& before, const std::vector<Bead>& after);

  /// The bead of the second scan whose surroundings are most like those of a bead of the first; nothing where
  /// none finds half of the neighbours again, or there are fewer than eight. The same for any number of
  /// threads.
  std::optional<Anchor> find(int before) const;

 private:
  struct Neighbour {
    Vec3 at;  ///< from the bead, in mean diameters
    double distance;
    int bead;
  };
  using Surroundings = std::vector<Neighbour>;  ///< in ascending distance
  struct Triangle {
    const Neighbour *first, *second;
    double side;
  };

  static std::vector<Surroundings> surroundings(const std::vector<Bead>& beads, double diameter);
  static std::optional<Triangle> triangle(const Surroundings& about);
  bool alike(int before, int after) const;
  Anchor compare(int before, const Triangle& triangle, int after) const;
  std::vector<std::pair<int, int>> found(const Surroundings& first, const Surroundings& second,
                                         const Eigen::Matrix3d& map, double radius) const;
  Anchor refined(int before, int after, Eigen::Matrix3d map) const;

  const std::vector<Bead>& before_;
  double diameter_;
  std::vector<Bead> after_;
  std::vector<Surroundings> first_, second_;
};

}  // namespace pendular::tracking
