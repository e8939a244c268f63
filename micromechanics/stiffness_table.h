#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>

#include "micromechanics/bond_stiffness.h"
#include "micromechanics/bridge_body.h"
#include "micromechanics/bridge_fe.h"

namespace pendular::micromechanics {

/// Gap over the bead diameter below which a bridge is taken to have this gap: touching beads have no finite
/// stiffness, and below a thousandth of D a real bead's roughness decides.
inline constexpr double kSmallestGapRatio = 1e-3;

/// Whether that applies; D = 2 D_i D_j/(D_i + D_j).
bool gap_is_raised(const BridgeBody& body);

/// The stiffness of many bridges of one Poisson ratio, interpolated between finite element solutions.
///
/// With D = 2 D_i D_j/(D_i + D_j) and s = ((D_i − D_j)/(D_i + D_j))², the logarithms of the dimensionless
/// stiffnesses of equal beads (s = 0) are polynomials of ln d/D and ln δ0/D through Chebyshev points, and so
/// is, through fewer, the relative change per s: unequal beads change each stiffness by a factor 1 + c s
/// (found to hold to 1e-4 up to D_j/D_i = 1.5). Where all necks, or all gaps, are the same over D, there is
/// one point of them. The table covers the bridges it was made for and no others.
class StiffnessTable {
 public:
  /// Solves and measures; in parallel, with results that do not depend on the number of threads. BadInput as
  /// check_bridge(), but for gaps, which count as kSmallestGapRatio × D where smaller (also below zero).
  StiffnessTable(std::span<const BridgeBody> bodies, const Polymer& polymer);

  BondStiffness at(const BridgeBody& body) const;

  /// Largest relative difference of any of the four from finite elements at points between those of the table
  /// (where the interpolation is worst), with equal and with the most unequal beads.
  double measured_error() const { return error_; }

  /// How many finite element solutions the table holds.
  std::size_t solutions() const { return solutions_; }

 private:
  using Four = Eigen::Array4d;

  /// Four functions on the range, given at Chebyshev points.
  struct Layer {
    Eigen::VectorXd neck, gap;              ///< ln d/D, ln δ0/D
    std::array<Eigen::MatrixXd, 4> values;  ///< neck × gap
    Four at(double ln_neck, double ln_gap) const;
  };
  struct Range {
    double low, high;
    int points(int of_many, int of_narrow) const;
  };
  struct Points;
  template <typename Function>
  Layer fill(const Points& points, const Function& function);
  void find_range(std::span<const BridgeBody> bodies);
  double measure() const;
  Four solve(double ln_neck, double ln_gap, double asymmetry) const;
  Four interpolate(double ln_neck, double ln_gap, double asymmetry) const;

  Polymer polymer_;
  Range neck_, gap_;
  double asymmetry_ = 0.0;            ///< |D_i − D_j|/(D_i + D_j), the largest
  double reference_asymmetry_ = 0.0;  ///< at which the change per s is found
  Layer equal_, change_;
  double error_ = 0.0;
  std::size_t solutions_ = 0;
};

}  // namespace pendular::micromechanics
