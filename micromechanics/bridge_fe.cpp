#include "micromechanics/bridge_fe.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "micromechanics/bridge_elements.h"
#include "micromechanics/bridge_field.h"
#include "micromechanics/fronts.h"

namespace pendular::micromechanics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One field on one grid with everything eliminated but the motions of the upper cap, the lower one (or the
/// middle of half a body) being held.
class Solution {
 public:
  Solution(const BridgeElements& elements, const BridgeField& field, const MatrixXd& law)
      : elements_(elements),
        field_(field),
        products_of_strains_(field.strain.transpose() * law * field.strain),
        motions_(static_cast<int>(field.motions.size())),
        rows_(elements.axial() * elements.order() + 1),
        free_((elements.radial() * elements.order() + 1) * rows_ * field.components),
        elimination_(free_ + motions_) {
    const Front rest = eliminate();
    stiffness_.resize(motions_, motions_);
    for (Index i = 0; i < motions_; ++i)
      for (Index j = 0; j <= i; ++j) {
        const Index row = rest.unknowns[static_cast<std::size_t>(i)] - free_;
        const Index column = rest.unknowns[static_cast<std::size_t>(j)] - free_;
        stiffness_(row, column) = stiffness_(column, row) = rest.matrix(i, j);
      }
    // Two halves, each of which takes half of the caps' relative motion.
    stiffness_ *= field.around * (elements.grid().half ? 0.5 : 1.0);
  }

  /// Against the relative motions of the caps, motions × motions.
  const MatrixXd& stiffness() const { return stiffness_; }

  /// All unknowns for a unit of the caps' first relative motion.
  VectorXd unit_motion() const {
    VectorXd values = VectorXd::Zero(free_ + motions_);
    values[free_] = elements_.grid().half ? 0.5 : 1.0;
    elimination_.substitute_back(values);
    return values;
  }

  /// Displacement at the nodes of element (a, b): shape functions × components.
  MatrixXd displacement(const VectorXd& values, int a, int b) const {
    MatrixXd nodes = MatrixXd::Zero(elements_.shapes(), field_.components);
    for (Index k = 0; k < nodes.size(); ++k) {
      const Node node = node_of(a, b, k);
      if (node.kind == Node::free)
        nodes(k) = values[node.unknown];
      else if (node.kind == Node::cap)
        nodes(k) = cap_motion(node, 0) * values[free_];
    }
    return nodes;
  }

 private:
  struct Node {
    enum { held, cap, free } kind;
    int component, unknown;
    double r;
  };

  /// Of local unknown k: component × shapes() + shape function.
  Node node_of(int a, int b, Index k) const {
    const int n = elements_.order() + 1, shape = static_cast<int>(k % elements_.shapes());
    const int component = static_cast<int>(k / elements_.shapes());
    const int column = a * elements_.order() + shape / n, row = b * elements_.order() + shape % n;
    const auto c = static_cast<std::size_t>(component);
    const bool held = (column == 0 && field_.zero_on_axis[c]) ||
                      (row == 0 && (!elements_.grid().half || field_.zero_in_middle[c]));
    const auto kind = held ? Node::held : row + 1 == rows_ ? Node::cap : Node::free;
    return {kind, component, (column * rows_ + row) * field_.components + component,
            elements_.node_radius(a, shape / n)};
  }

  double cap_motion(const Node& node, int motion) const {
    return field_.motions[static_cast<std::size_t>(motion)](node.component, node.r,
                                                            elements_.grid().section(node.r).upper);
  }

  /// Stiffness of an element against all its local unknowns.
  MatrixXd element_matrix(int a, int b) const {
    const Index n = elements_.shapes(), c = field_.components;
    const MatrixXd& products = elements_.products(a, b);
    MatrixXd matrix = MatrixXd::Zero(c * n, c * n);
    for (Index i = 0; i < c; ++i)
      for (Index j = 0; j <= i; ++j)
        for (Index p = 0; p < operators; ++p)
          for (Index q = 0; q < operators; ++q)
            if (const double factor = products_of_strains_(i * operators + p, j * operators + q);
                factor != 0.0)
              matrix.block(i * n, j * n, n, n) += factor * products.block(p * n, q * n, n, n);
    matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
    return matrix;
  }

  /// The same against the free unknowns and the motions of the cap.
  Front element_front(int a, int b) const {
    const MatrixXd matrix = element_matrix(a, b);
    MatrixXd cap = MatrixXd::Zero(matrix.rows(), motions_);
    std::vector<Index> kept;
    Front front;
    for (Index k = 0; k < matrix.rows(); ++k) {
      const Node node = node_of(a, b, k);
      if (node.kind == Node::cap)
        for (int motion = 0; motion < motions_; ++motion) cap(k, motion) = cap_motion(node, motion);
      if (node.kind != Node::free) continue;
      kept.push_back(k);
      front.unknowns.push_back(node.unknown);
    }
    const auto size = static_cast<Index>(kept.size());
    const int extra = b + 1 == elements_.axial() ? motions_ : 0;
    for (int motion = 0; motion < extra; ++motion) front.unknowns.push_back(free_ + motion);
    front.matrix.resize(size + extra, size + extra);
    front.matrix.topLeftCorner(size, size) = matrix(kept, kept);
    if (extra == 0) return front;
    const MatrixXd pull = matrix * cap;
    front.matrix.bottomLeftCorner(extra, size) = pull(kept, Eigen::all).transpose();
    front.matrix.bottomRightCorner(extra, extra) = cap.transpose() * pull;
    return front;
  }

  /// From the axis outwards: first the inside of each element, then the column of elements but for its outer
  /// side, which the next column shares.
  Front eliminate() {
    const int order = elements_.order();
    Front rest;
    for (int a = 0; a < elements_.radial(); ++a) {
      std::vector<Front> parts = {std::move(rest)};
      for (int b = 0; b < elements_.axial(); ++b)
        parts.push_back(elimination_.eliminate({element_front(a, b)}, [&](int unknown) {
          const int node = unknown / field_.components;
          return unknown < free_ && node / rows_ % order != 0 && node % rows_ % order != 0;
        }));
      const int limit = a + 1 == elements_.radial() ? free_ : (a + 1) * order * rows_ * field_.components;
      rest = elimination_.eliminate(parts, [&](int unknown) { return unknown < limit; });
    }
    return rest;
  }

  const BridgeElements& elements_;
  BridgeField field_;
  MatrixXd products_of_strains_;
  int motions_, rows_, free_;  ///< free_: numbers of unknowns below it; the motions follow
  Elimination elimination_;
  MatrixXd stiffness_;
};

/// For Young's modulus and radius of the neck 1.
struct UnitStiffness : BondStiffness {
  double coupling = 0.0;
};

UnitStiffness solve(const BridgeElements& elements, const Solution& stretch, const MatrixXd& law) {
  UnitStiffness k;
  k.normal = stretch.stiffness()(0, 0);
  k.twisting = Solution(elements, twist_field(), law).stiffness()(0, 0);
  if (elements.grid().half) {
    k.tangential = Solution(elements, shear_field(), law).stiffness()(0, 0);
    k.bending = Solution(elements, bend_field(), law).stiffness()(0, 0);
  } else {
    const MatrixXd both = Solution(elements, shear_and_bend_field(), law).stiffness();
    k.tangential = both(0, 0);
    k.bending = both(1, 1);
    k.coupling = both(0, 1);
  }
  return k;
}

/// Stress of the stretched body at points of one element: strains × points.
MatrixXd stress_at(const Solution& stretch, const VectorXd& values, const MatrixXd& law, int a, int b,
                   const ShapeOperators& shape) {
  const MatrixXd nodes = stretch.displacement(values, a, b);
  MatrixXd derivatives(2 * operators, shape.volume.size());
  for (Index c = 0; c < 2; ++c)
    for (Index o = 0; o < operators; ++o)
      derivatives.row(c * operators + o) = nodes.col(c).transpose() * shape.on[static_cast<std::size_t>(o)];
  return law * (stretch_field().strain * derivatives);
}

BridgeStress stretch_stress(const BridgeElements& elements, const Solution& stretch, const MatrixXd& law) {
  const VectorXd values = stretch.unit_motion();
  BridgeStress s;
  double volume = 0.0;
  const VectorXd &points = elements.rule().points, &weights = elements.rule().weights;
  const MatrixXd weight = weights * weights.transpose();
  for (int a = 0; a < elements.radial(); ++a)
    for (int b = 0; b < elements.axial(); ++b) {
      const ShapeOperators shape = elements.at(a, b, points, points);
      const MatrixXd stress = stress_at(stretch, values, law, a, b, shape);
      const VectorXd share = shape.volume.array() * weight.reshaped().array();
      volume += share.sum();
      s.mean_average += stress.topRows(3).colwise().sum().dot(share) / 3.0;
      s.axial_average += stress.row(e_zz).dot(share);
    }
  s.mean_average /= volume;
  s.axial_average /= volume;

  // The middle: the lower side of half a body, or between the two middle elements, whose stresses differ
  // by a little of their error.
  const int middle = elements.grid().half ? 0 : elements.axial() / 2;
  const VectorXd across = VectorXd::LinSpaced(elements.order() + 1, 0.0, 1.0);
  const VectorXd low = VectorXd::Zero(1), high = VectorXd::Ones(1);
  for (int a = 0; a < elements.radial(); ++a) {
    MatrixXd stress = stress_at(stretch, values, law, a, middle, elements.at(a, middle, across, low));
    if (!elements.grid().half)
      stress = 0.5 * (stress + stress_at(stretch, values, law, a, middle - 1,
                                         elements.at(a, middle - 1, across, high)));
    const VectorXd mean = stress.topRows(3).colwise().sum() / 3.0;
    if (a == 0) {
      s.mean_centre = s.mean_greatest = mean[0];
      s.axial_centre = stress(e_zz, 0);
    }
    s.mean_greatest = std::max(s.mean_greatest, mean.maxCoeff());
    s.mean_rim = mean[mean.size() - 1];
    s.axial_rim = stress(e_zz, mean.size() - 1);
  }
  return s;
}

BondStiffness in_si(const BondStiffness& unit, const BridgeBody& body, double youngs_modulus) {
  const double radius = 0.5 * body.neck_diameter, force = youngs_modulus * radius;
  const double moment = force * radius * radius;
  return {force * unit.normal, force * unit.tangential, moment * unit.bending, moment * unit.twisting};
}

BridgeStress in_si(BridgeStress stress, const BridgeBody& body, double youngs_modulus) {
  for (double* value : {&stress.mean_average, &stress.axial_average, &stress.mean_centre,
                        &stress.axial_centre, &stress.mean_rim, &stress.axial_rim, &stress.mean_greatest})
    *value *= youngs_modulus / (0.5 * body.neck_diameter);
  return stress;
}

double largest_difference(const BondStiffness& a, const BondStiffness& b) {
  return std::max({std::abs(a.normal / b.normal - 1.0), std::abs(a.tangential / b.tangential - 1.0),
                   std::abs(a.bending / b.bending - 1.0), std::abs(a.twisting / b.twisting - 1.0)});
}

}  // namespace

void check_bridge(const BridgeBody& body, const Polymer& polymer) {
  const double smaller = std::min(body.diameter_i, body.diameter_j), um = 1e6;
  const double larger = std::max(body.diameter_i, body.diameter_j);
  if (!(smaller > 0.0) || !std::isfinite(larger))
    bad_input("bridge: bead diameter: found {:.6g} um, expected more than 0", um * smaller);
  if (!(body.neck_diameter > 0.0 && body.neck_diameter < smaller))
    bad_input(
        "bridge: bridge diameter d: found {:.6g} um, expected more than 0 and less than the bead's {:.6g} um",
        um * body.neck_diameter, um * smaller);
  if (!(body.gap > 0.0) || !std::isfinite(body.gap))
    bad_input("bridge: gap: found {:.6g} um, expected more than 0 (touching beads have no finite stiffness)",
              um * body.gap);
  if (!(polymer.youngs_modulus > 0.0) || !std::isfinite(polymer.youngs_modulus))
    bad_input("bridge: Young's modulus: found {:.6g} Pa, expected more than 0", polymer.youngs_modulus);
  if (!(polymer.poisson_ratio >= 0.0 && polymer.poisson_ratio < 0.5))
    bad_input("bridge: Poisson ratio: found {:.6g}, expected at least 0 and less than 0.5",
              polymer.poisson_ratio);
}

bool within_verified_range(const BridgeBody& body, const Polymer& polymer) {
  // Values typed in decimal may miss the bounds by rounding.
  const auto within = [](double value, double low, double high) {
    return value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9);
  };
  const double smaller = std::min(body.diameter_i, body.diameter_j);
  return within(body.neck_diameter / smaller, 0.1, 0.8) && within(body.gap / smaller, 0.001, 0.1) &&
         within(body.diameter_i / body.diameter_j, 0.8, 1.25) && polymer.poisson_ratio <= 0.499;
}

BridgeStiffness bridge_stiffness(const BridgeBody& body, const Polymer& polymer) {
  check_bridge(body, polymer);
  const BridgeResolution fine;
  BridgeResolution coarse = fine;
  --coarse.order;
  --coarse.rim_layers;
  const MatrixXd law = elasticity(polymer.poisson_ratio);
  const BridgeElements elements(bridge_grid(body, fine));
  const Solution stretch(elements, stretch_field(), law);
  const UnitStiffness unit = solve(elements, stretch, law);

  BridgeStiffness result{in_si(unit, body, polymer.youngs_modulus), 0.0, 0.0, {}};
  result.coupling = polymer.youngs_modulus * 0.25 * body.neck_diameter * body.neck_diameter * unit.coupling;
  result.error_estimate = largest_difference(bridge_stiffness_on(body, polymer, coarse), result);
  result.stress = in_si(stretch_stress(elements, stretch, law), body, polymer.youngs_modulus);
  return result;
}

BondStiffness bridge_stiffness_on(const BridgeBody& body, const Polymer& polymer,
                                  const BridgeResolution& resolution) {
  check_bridge(body, polymer);
  const MatrixXd law = elasticity(polymer.poisson_ratio);
  const BridgeElements elements(bridge_grid(body, resolution));
  return in_si(solve(elements, Solution(elements, stretch_field(), law), law), body, polymer.youngs_modulus);
}

}  // namespace pendular::micromechanics
