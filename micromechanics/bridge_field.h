#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "micromechanics/bridge_elements.h"

namespace pendular::micromechanics {

/// Strains in cylindrical coordinates, the last three engineering shear strains.
enum Strain { e_rr, e_tt, e_zz, g_rt, g_rz, g_tz, strains };

/// Displacements of one Fourier harmonic around the axis, and the motions of the upper cap that excite them.
struct BridgeField {
  int components = 0;
  double around = 0.0;     ///< ∫ of the harmonic squared over the angle
  Eigen::MatrixXd strain;  ///< strains × (components × operators)
  std::vector<bool> zero_on_axis;
  std::vector<bool> zero_in_middle;  ///< by symmetry, where half a body is taken
  /// One component of a cap's motion at (r, z).
  std::vector<std::function<double(int component, double r, double z)>> motions;
};

/// Harmonic 0 of (u_r, u_z): the cap moved along the axis.
BridgeField stretch_field();

/// Harmonic 0 of u_θ: the cap turned about the axis.
BridgeField twist_field();

/// Harmonic 1, of which (u_r + u_θ)/2, (u_r − u_θ)/2, u_z are taken: the second alone may differ from zero on
/// the axis, where u_r = −u_θ. The cap moved across (shear), turned about the transverse axis through mid-gap
/// (bend), or both as two motions.
BridgeField shear_field();
BridgeField bend_field();
BridgeField shear_and_bend_field();

/// Hooke's law, strains × strains, for Young's modulus 1.
Eigen::MatrixXd elasticity(double poisson_ratio);

}  // namespace pendular::micromechanics
