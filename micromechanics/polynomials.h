#pragma once

#include <Eigen/Dense>

namespace pendular::micromechanics {

/// Points and weights of a quadrature on [0, 1].
struct Quadrature {
  Eigen::VectorXd points, weights;
};

/// Gauss–Legendre rule, exact to degree 2 × size − 1 (Golub & Welsch 1969, Math. Comp. 23, 221).
Quadrature gauss_legendre(int size);

/// The size = order + 1 points of Gauss, Legendre and Lobatto on [0, 1]: both ends and the extrema of the
/// Legendre polynomial of that order. Rising.
Eigen::VectorXd lobatto_points(int order);

/// Lagrange polynomials of some nodes and their derivatives at some points: one row per polynomial, one
/// column per point.
struct LagrangeValues {
  Eigen::MatrixXd values, derivatives;
};
LagrangeValues lagrange(const Eigen::VectorXd& nodes, const Eigen::VectorXd& points);

}  // namespace pendular::micromechanics
