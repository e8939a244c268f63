#pragma once

#include <array>
#include <vector>

#include "micromechanics/bridge_grid.h"
#include "micromechanics/polynomials.h"

namespace pendular::micromechanics {

/// What strains in a body of revolution are made of: a displacement component's derivatives along r and z,
/// and the component over r.
enum Operator { d_r, d_z, over_r, operators };

/// The operators applied to the shape functions of an element, at some points.
struct ShapeOperators {
  std::array<Eigen::MatrixXd, operators> on;  ///< shape functions × points
  Eigen::VectorXd volume;  ///< per point: dr dz r per unit of the element's own coordinates
};

/// The elements of a grid: products of Lagrange polynomials on Lobatto points. Shape function
/// i (order + 1) + j is that of radial node i and axial node j. Element coordinates run over [0, 1]².
class BridgeElements {
 public:
  explicit BridgeElements(const BridgeGrid& grid);

  const BridgeGrid& grid() const { return grid_; }
  int order() const { return grid_.order; }
  int radial() const { return static_cast<int>(grid_.radial.size()) - 1; }
  int axial() const { return static_cast<int>(grid_.axial.size()) - 1; }
  Eigen::Index shapes() const { return nodes_.size() * nodes_.size(); }
  double node_radius(int a, int i) const { return radius(a, nodes_[i]); }
  double radius(int a, double t) const { return between(grid_.radial, a, t); }

  /// Integrals over element (a, b), per radian, of the products of any two operators on any two shape
  /// functions: (operators × shape functions)², symmetric.
  const Eigen::MatrixXd& products(int a, int b) const {
    return products_[static_cast<std::size_t>(a * axial() + b)];
  }

  /// At the grid of some radial and some axial points, the latter fastest. On the axis `over_r` is the limit
  /// for a component that is zero there: d_r.
  ShapeOperators at(int a, int b, const Eigen::VectorXd& radial_points,
                    const Eigen::VectorXd& axial_points) const;

  /// Quadrature along each side of an element.
  const Quadrature& rule() const { return rule_; }

 private:
  static double between(const Eigen::VectorXd& bounds, int k, double t) {
    return bounds[k] + t * (bounds[k + 1] - bounds[k]);
  }
  Eigen::MatrixXd integrate(int a, int b) const;

  BridgeGrid grid_;
  Eigen::VectorXd nodes_;
  Quadrature rule_;
  std::vector<Eigen::MatrixXd> products_;
};

}  // namespace pendular::micromechanics
