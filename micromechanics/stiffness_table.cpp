#include "micromechanics/stiffness_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "micromechanics/polynomials.h"

namespace pendular::micromechanics {
namespace {

using Eigen::Index;

constexpr double kWantedError = 5e-4;
constexpr double kSame = 1e-9, kClose = 1e-3;  // of logarithms: rounding, and too close for points
constexpr double kNarrow = 0.3;                // of a logarithm: bridges of one gap on beads that differ

/// Chebyshev points of the first kind of a range.
Eigen::VectorXd chebyshev_points(int size, double low, double high) {
  Eigen::VectorXd points(size);
  for (int k = 0; k < size; ++k)
    points[k] = 0.5 * (low + high) - 0.5 * (high - low) * std::cos(M_PI * (k + 0.5) / size);
  return points;
}

double common_diameter(const BridgeBody& body) {
  return 2.0 * body.diameter_i * body.diameter_j / (body.diameter_i + body.diameter_j);
}

double asymmetry_of(const BridgeBody& body) {
  return std::abs(body.diameter_i - body.diameter_j) / (body.diameter_i + body.diameter_j);
}

double ln_neck_of(const BridgeBody& body) {
  return std::log(body.neck_diameter / common_diameter(body));
}

double ln_gap_of(const BridgeBody& body) {
  return std::log(std::max(body.gap / common_diameter(body), kSmallestGapRatio));
}

}  // namespace

/// Points along ln d/D and ln δ0/D, and at most along either where its range is narrow.
struct StiffnessTable::Points {
  int neck, gap, narrow;
};

int StiffnessTable::Range::points(int of_many, int of_narrow) const {
  if (high <= low) return 1;
  return high - low < kNarrow ? std::min(of_many, of_narrow) : of_many;
}

bool gap_is_raised(const BridgeBody& body) {
  return body.gap < kSmallestGapRatio * common_diameter(body);
}

StiffnessTable::Four StiffnessTable::Layer::at(double ln_neck, double ln_gap) const {
  const Eigen::VectorXd along_neck = lagrange(neck, Eigen::VectorXd::Constant(1, ln_neck)).values;
  const Eigen::VectorXd along_gap = lagrange(gap, Eigen::VectorXd::Constant(1, ln_gap)).values;
  Four four;
  for (std::size_t k = 0; k < 4; ++k) four[static_cast<Index>(k)] = along_neck.dot(values[k] * along_gap);
  return four;
}

template <typename Function>
StiffnessTable::Layer StiffnessTable::fill(const Points& points, const Function& function) {
  const int necks = neck_.points(points.neck, points.narrow), gaps = gap_.points(points.gap, points.narrow);
  Layer layer{
      chebyshev_points(necks, neck_.low, neck_.high), chebyshev_points(gaps, gap_.low, gap_.high), {}};
  for (auto& matrix : layer.values) matrix.resize(necks, gaps);
  const auto size = static_cast<std::size_t>(necks) * static_cast<std::size_t>(gaps);
  for_blocks(size, 1, [&](std::size_t node, std::size_t) {
    stop_if_interrupted();
    const Index i = static_cast<Index>(node) / gaps, j = static_cast<Index>(node) % gaps;
    const Four four = function(layer.neck[i], layer.gap[j]);
    for (std::size_t k = 0; k < 4; ++k) layer.values[k](i, j) = four[static_cast<Index>(k)];
  });
  solutions_ += size;
  return layer;
}

void StiffnessTable::find_range(std::span<const BridgeBody> bodies) {
  bool first = true;
  for (BridgeBody body : bodies) {
    const double neck = ln_neck_of(body), gap = ln_gap_of(body);
    body.gap = std::exp(gap) * common_diameter(body);
    check_bridge(body, polymer_);
    if (first) {
      neck_ = {neck, neck};
      gap_ = {gap, gap};
      first = false;
    }
    neck_ = {std::min(neck_.low, neck), std::max(neck_.high, neck)};
    gap_ = {std::min(gap_.low, gap), std::max(gap_.high, gap)};
    asymmetry_ = std::max(asymmetry_, asymmetry_of(body));
  }
  for (Range* range : {&neck_, &gap_})
    if (const double width = range->high - range->low; width < kSame)
      range->low = range->high = 0.5 * (range->low + range->high);
    else if (width < kClose)
      *range = {range->low - 0.5 * kClose, range->high + 0.5 * kClose};
  // The smaller bead of the reference has to be wider than the widest neck.
  reference_asymmetry_ = std::min(0.1, 0.5 * (std::exp(-neck_.high) - 1.0));
}

StiffnessTable::Four StiffnessTable::solve(double ln_neck, double ln_gap, double asymmetry) const {
  const BridgeBody body{std::exp(ln_neck), std::exp(ln_gap), 1.0 / (1.0 + asymmetry),
                        1.0 / (1.0 - asymmetry)};
  const BondStiffness k = bridge_stiffness_on(body, {1.0, polymer_.poisson_ratio}, {});
  return {k.normal, k.tangential, k.bending, k.twisting};
}

StiffnessTable::Four StiffnessTable::interpolate(double ln_neck, double ln_gap, double asymmetry) const {
  Four four = equal_.at(ln_neck, ln_gap).exp();
  if (asymmetry > 0.0) four *= 1.0 + change_.at(ln_neck, ln_gap) * asymmetry * asymmetry;
  return four;
}

double StiffnessTable::measure() const {
  // Between Chebyshev points and at the ends of a range the error of a polynomial has its extrema.
  constexpr int kSide = 4;
  const int necks = neck_.points(kSide, kSide), gaps = gap_.points(kSide, kSide);
  const auto place = [&](const Range& range, Index points, Index k) {
    const Index extremum = k * points / (kSide - 1);
    return 0.5 * (range.low + range.high) -
           0.5 * (range.high - range.low) *
               std::cos(M_PI * static_cast<double>(extremum) / static_cast<double>(points));
  };
  std::vector<double> errors(static_cast<std::size_t>(necks * gaps));
  for_blocks(errors.size(), 1, [&](std::size_t check, std::size_t) {
    stop_if_interrupted();
    const int i = static_cast<int>(check) / gaps, j = static_cast<int>(check) % gaps;
    const double neck = place(neck_, equal_.neck.size(), i), gap = place(gap_, equal_.gap.size(), j);
    const bool fits = std::exp(neck) * (1.0 + asymmetry_) < 0.99;
    const double asymmetry = (errors.size() == 1 || (i + j) % 2 == 1) && fits ? asymmetry_ : 0.0;
    errors[check] = (interpolate(neck, gap, asymmetry) / solve(neck, gap, asymmetry) - 1.0).abs().maxCoeff();
  });
  return *std::max_element(errors.begin(), errors.end());
}

StiffnessTable::StiffnessTable(std::span<const BridgeBody> bodies, const Polymer& polymer)
    : polymer_(polymer) {
  constexpr std::array kPoints = {Points{7, 12, 4}, Points{10, 16, 16}};  // tried in turn
  constexpr Points kPointsOfChange = {4, 4, 4};
  if (bodies.empty()) return;
  find_range(bodies);
  if (asymmetry_ > 0.0)
    change_ = fill(kPointsOfChange, [&](double neck, double gap) -> Four {
      const double s = reference_asymmetry_ * reference_asymmetry_;
      return (solve(neck, gap, reference_asymmetry_) / solve(neck, gap, 0.0) - 1.0) / s;
    });
  for (const Points& points : kPoints) {
    equal_ = fill(points, [&](double neck, double gap) -> Four { return solve(neck, gap, 0.0).log(); });
    error_ = measure();
    if (error_ < kWantedError) break;
  }
}

BondStiffness StiffnessTable::at(const BridgeBody& body) const {
  const double diameter = common_diameter(body), force = polymer_.youngs_modulus * diameter;
  const double moment = force * diameter * diameter;
  const Four k = interpolate(ln_neck_of(body), ln_gap_of(body), asymmetry_of(body));
  return {force * k[0], force * k[1], moment * k[2], moment * k[3]};
}

}  // namespace pendular::micromechanics
