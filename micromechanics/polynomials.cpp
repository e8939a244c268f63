#include "micromechanics/polynomials.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace pendular::micromechanics {
namespace {

/// Eigenvalues, rising, and eigenvectors of the Jacobi matrix with zero diagonal and the given off-diagonal.
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> jacobi_matrix(const Eigen::VectorXd& off_diagonal) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::VectorXd::Zero(off_diagonal.size() + 1), off_diagonal);
  return solver;
}

}  // namespace

Quadrature gauss_legendre(int size) {
  Eigen::VectorXd off(size - 1);
  for (int k = 1; k < size; ++k) off[k - 1] = k / std::sqrt(4.0 * k * k - 1.0);
  const auto solver = jacobi_matrix(off);
  return {(0.5 + 0.5 * solver.eigenvalues().array()).matrix(),
          solver.eigenvectors().row(0).transpose().array().square().matrix()};
}

Eigen::VectorXd lobatto_points(int order) {
  Eigen::VectorXd points(order + 1);
  points[0] = 0.0;
  points[order] = 1.0;
  if (order < 2) return points;
  // The inner ones are the Gauss points of the weight 1 − x².
  Eigen::VectorXd off(order - 2);
  for (int k = 1; k < order - 1; ++k)
    off[k - 1] = std::sqrt(k * (k + 2.0) / ((2.0 * k + 1.0) * (2.0 * k + 3.0)));
  points.segment(1, order - 1) = 0.5 + 0.5 * jacobi_matrix(off).eigenvalues().array();
  return points;
}

LagrangeValues lagrange(const Eigen::VectorXd& nodes, const Eigen::VectorXd& points) {
  const Eigen::Index n = nodes.size();
  LagrangeValues result{Eigen::MatrixXd(n, points.size()), Eigen::MatrixXd(n, points.size())};
  for (Eigen::Index q = 0; q < points.size(); ++q)
    for (Eigen::Index i = 0; i < n; ++i) {
      double value = 1.0, derivative = 0.0;
      for (Eigen::Index k = 0; k < n; ++k) {
        if (k == i) continue;
        const double width = nodes[i] - nodes[k];
        derivative = (derivative * (points[q] - nodes[k]) + value) / width;
        value *= (points[q] - nodes[k]) / width;
      }
      result.values(i, q) = value;
      result.derivatives(i, q) = derivative;
    }
  return result;
}

}  // namespace pendular::micromechanics
