#include "micromechanics/bridge_elements.h"

#include <cmath>

namespace pendular::micromechanics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

BridgeElements::BridgeElements(const BridgeGrid& grid)
    : grid_(grid), nodes_(lobatto_points(grid.order)), rule_(gauss_legendre(grid.order + 2)) {
  for (int a = 0; a < radial(); ++a)
    for (int b = 0; b < axial(); ++b) products_.push_back(integrate(a, b));
}

MatrixXd BridgeElements::integrate(int a, int b) const {
  const ShapeOperators shape = at(a, b, rule_.points, rule_.points);
  const MatrixXd weights = rule_.weights * rule_.weights.transpose();
  const Index n = shapes(), points = shape.volume.size();
  const VectorXd root = (shape.volume.array() * weights.reshaped().array()).sqrt();
  MatrixXd weighted(operators * n, points);
  for (Index o = 0; o < operators; ++o)
    weighted.middleRows(o * n, n) = shape.on[static_cast<std::size_t>(o)] * root.asDiagonal();
  MatrixXd products = MatrixXd::Zero(operators * n, operators * n);
  products.selfadjointView<Eigen::Lower>().rankUpdate(weighted);
  products.triangularView<Eigen::StrictlyUpper>() = products.transpose();
  return products;
}

ShapeOperators BridgeElements::at(int a, int b, const VectorXd& radial_points,
                                  const VectorXd& axial_points) const {
  const double width = grid_.radial[a + 1] - grid_.radial[a], depth = grid_.axial[b + 1] - grid_.axial[b];
  const LagrangeValues along_r = lagrange(nodes_, radial_points), along_z = lagrange(nodes_, axial_points);
  const Index n = nodes_.size(), points = radial_points.size() * axial_points.size();
  ShapeOperators shape;
  for (auto& matrix : shape.on) matrix.resize(n * n, points);
  shape.volume.resize(points);
  Index point = 0;
  for (Index u = 0; u < radial_points.size(); ++u) {
    const double r = radius(a, radial_points[u]);
    const BridgeGrid::Section s = grid_.section(r);
    const double height = s.upper - s.lower;
    for (Index v = 0; v < axial_points.size(); ++v, ++point) {
      const double eta = between(grid_.axial, b, axial_points[v]);
      const double slope = s.lower_slope + eta * (s.upper_slope - s.lower_slope);  // of lines of equal η
      shape.volume[point] = r * height * width * depth;
      for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
          const Index k = i * n + j;
          const double by_z = along_r.values(i, u) * along_z.derivatives(j, v) / (depth * height);
          const double by_r = along_r.derivatives(i, u) / width * along_z.values(j, v) - slope * by_z;
          shape.on[d_z](k, point) = by_z;
          shape.on[d_r](k, point) = by_r;
          shape.on[over_r](k, point) = r > 0.0 ? along_r.values(i, u) * along_z.values(j, v) / r : by_r;
        }
    }
  }
  return shape;
}

}  // namespace pendular::micromechanics
