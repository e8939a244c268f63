#include "phantom/phantom_raster.h"

#include <algorithm>
#include <cmath>

namespace pendular::phantom {
namespace {

constexpr double tails = 4.5;  // standard deviations beyond which a Gaussian is left out: 3e-6 of an edge

double below(double u) {
  return 0.5 * std::erfc(-u * M_SQRT1_2);
}  // Φ
double density(double u) {
  return std::exp(-0.5 * u * u) * 0.5 * M_SQRT1_2 * M_2_SQRTPI;
}  // φ

double blurred_ball(double r, double radius, double s) {
  const double u = (radius - r) / s;
  if (r < 1e-6 * s) return 2.0 * below(radius / s) - 1.0 - 2.0 * radius / s * density(radius / s);
  const double v = (radius + r) / s;
  if (v > 2.0 * tails) return below(u) - s / r * density(u);
  return below(u) + below(v) - 1.0 - s / r * (density(u) - density(v));
}

/// e^(−x) I0(x) to 2e-7: Abramowitz & Stegun 1964, 9.8.1 and 9.8.2.
double scaled_bessel_i0(double x) {
  if (x < 3.75) {
    const double t = (x / 3.75) * (x / 3.75);
    const double i0 =
        1.0 + t * (3.5156229 +
                   t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
    return std::exp(-x) * i0;
  }
  const double t = 3.75 / x;
  const double tail = -0.02057706 + t * (0.02635537 + t * (-0.01647633 + t * 0.00392377));
  return (0.39894228 +
          t * (0.01328592 + t * (0.00225319 + t * (-0.00157565 + t * (0.00916281 + t * tail))))) /
         std::sqrt(x);
}

struct Node {
  double place, weight;
};

/// Gauss–Legendre quadrature on [0, length].
std::vector<Node> gauss_legendre(unsigned count, double length) {
  std::vector<Node> nodes;
  for (unsigned k = 0; k < count; ++k) {
    double x = std::cos(M_PI * (k + 0.75) / (count + 0.5));
    double slope = 0.0;
    for (int iteration = 0; iteration < 8; ++iteration) {
      const double value = std::legendre(count, x);
      slope = count * (x * value - std::legendre(count - 1, x)) / (x * x - 1.0);
      x -= value / slope;
    }
    nodes.push_back({0.5 * length * (1.0 + x), length / ((1.0 - x * x) * slope * slope)});
  }
  return nodes;
}

/// Calls f(x, y) for the voxels of the slice inside the box of half-widths `half` about `middle`.
template <typename Function>
void for_box(const Vec3& middle, const Vec3& half, const Slice& slice, const Function& f) {
  if (std::abs(slice.z - middle.z()) > half.z()) return;
  const int y0 = static_cast<int>(std::max(0.0, std::ceil(middle.y() - half.y())));
  const int y1 = static_cast<int>(std::min(slice.ny - 1.0, std::floor(middle.y() + half.y())));
  const int x0 = static_cast<int>(std::max(0.0, std::ceil(middle.x() - half.x())));
  const int x1 = static_cast<int>(std::min(slice.nx - 1.0, std::floor(middle.x() + half.x())));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) f(x, y);
}

float& voxel_at(const Slice& slice, int x, int y) {
  return slice
      .voxels[static_cast<std::size_t>(y) * static_cast<std::size_t>(slice.nx) + static_cast<std::size_t>(x)];
}

/// Mean of f(point) over the cells of a voxel at `voxel`.
template <typename Function>
float mean_over_cells(const Sharpness& sharpness, const Vec3& voxel, const Function& f) {
  const auto& offsets = sharpness.offsets;
  double sum = 0.0;
  for (double z : offsets)
    for (double y : offsets)
      for (double x : offsets) sum += f(voxel + Vec3(x, y, z));
  return static_cast<float>(sum / static_cast<double>(offsets.size() * offsets.size() * offsets.size()));
}

}  // namespace

Sharpness::Sharpness(double point_spread_sd) {
  const double cell = point_spread_sd >= 0.8 ? 1.0 : 0.5;
  sd = std::sqrt(point_spread_sd * point_spread_sd + cell * cell / 12.0);
  offsets = cell == 1.0 ? std::vector<double>{0.0} : std::vector<double>{-0.25, 0.25};
}

double Sharpness::reach() const {
  return tails * sd + std::sqrt(3.0) * offsets.back();
}

void add_ball(const Ball& ball, const Sharpness& sharpness, const Slice& slice) {
  const double reach = sharpness.reach();
  const double outer = (ball.radius + reach) * (ball.radius + reach);
  const double inner = ball.radius > reach ? (ball.radius - reach) * (ball.radius - reach) : -1.0;
  for_box(ball.centre, Vec3::Constant(ball.radius + reach), slice, [&](int x, int y) {
    const Vec3 from_centre = Vec3(x, y, slice.z) - ball.centre;
    const double distance2 = from_centre.squaredNorm();
    if (distance2 >= outer) return;
    if (distance2 <= inner) {
      voxel_at(slice, x, y) += 1.0F;
      return;
    }
    voxel_at(slice, x, y) += mean_over_cells(sharpness, from_centre, [&](const Vec3& point) {
      return blurred_ball(point.norm(), ball.radius, sharpness.sd);
    });
  });
}

// In cylindrical coordinates (ϱ, t) about the axis, a Gaussian of sd s carries a ring of radius ϱ' to ϱ with
//   K(ϱ, ϱ') = exp(−(ϱ² + ϱ'²)/(2 s²)) I0(ϱ ϱ'/s²) / s²,
// so that the neck, which at ϱ' reaches from t_a(ϱ') on ball a to t_b(ϱ') on ball b, becomes
//   ∫ K(ϱ, ϱ') [Φ((t − t_a)/s) − Φ((t − t_b)/s)] ϱ' dϱ'.
NeckImage::NeckImage(const Neck& neck, const Sharpness& sharpness)
    : sharpness_(&sharpness), centre_(neck.a.centre), step_(sharpness.sd / 8.0) {
  const double length = (neck.b.centre - neck.a.centre).norm();
  axis_ = (neck.b.centre - neck.a.centre) / length;
  const double s = sharpness.sd, radius = neck.radius;
  const auto surface_a = [&](double across) {
    return std::sqrt(neck.a.radius * neck.a.radius - across * across);
  };
  const auto surface_b = [&](double across) {
    return length - std::sqrt(neck.b.radius * neck.b.radius - across * across);
  };
  const double from = surface_a(radius), to = std::max(from, surface_b(radius));
  start_ = from - tails * s;
  rows_ = static_cast<std::size_t>(std::ceil((to - from + 2.0 * tails * s) / step_)) + 1;
  columns_ = static_cast<std::size_t>(std::ceil((radius + tails * s) / step_)) + 1;
  middle_ = centre_ + 0.5 * (from + to) * axis_;
  const Vec3 across_axis = (Vec3::Ones() - axis_.cwiseProduct(axis_)).cwiseMax(0.0).cwiseSqrt();
  half_ = 0.5 * (to - from) * axis_.cwiseAbs() + radius * across_axis + Vec3::Constant(sharpness.reach());

  table_.assign(rows_ * columns_, 0.0F);
  const auto count = static_cast<unsigned>(std::ceil(5.0 + 2.5 * radius / s));
  std::vector<float> ring(columns_);
  for (const Node& node : gauss_legendre(count, radius)) {
    const double t_a = surface_a(node.place), t_b = surface_b(node.place);
    if (t_b <= t_a) continue;
    for (std::size_t c = 0; c < columns_; ++c) {
      const double across = static_cast<double>(c) * step_;
      ring[c] = static_cast<float>(node.weight * node.place / (s * s) *
                                   std::exp(-0.5 * std::pow((across - node.place) / s, 2)) *
                                   scaled_bessel_i0(across * node.place / (s * s)));
    }
    for (std::size_t r = 0; r < rows_; ++r) {
      const double along = start_ + static_cast<double>(r) * step_;
      const auto between = static_cast<float>(below((along - t_a) / s) - below((along - t_b) / s));
      float* row = table_.data() + r * columns_;
      for (std::size_t c = 0; c < columns_; ++c) row[c] += between * ring[c];
    }
  }
}

bool NeckImage::touches(int z) const {
  return std::abs(z - middle_.z()) <= half_.z();
}

double NeckImage::at(double along, double across) const {
  const double r = (along - start_) / step_, c = across / step_;
  if (r < 0.0 || r >= static_cast<double>(rows_ - 1) || c >= static_cast<double>(columns_ - 1)) return 0.0;
  const auto row = static_cast<std::size_t>(r), column = static_cast<std::size_t>(c);
  const double u = r - static_cast<double>(row), v = c - static_cast<double>(column);
  const float* corner = table_.data() + row * columns_ + column;
  return (1.0 - u) * ((1.0 - v) * corner[0] + v * corner[1]) +
         u * ((1.0 - v) * corner[columns_] + v * corner[columns_ + 1]);
}

void NeckImage::add_to(const Slice& slice) const {
  for_box(middle_, half_, slice, [&](int x, int y) {
    voxel_at(slice, x, y) +=
        mean_over_cells(*sharpness_, Vec3(x, y, slice.z) - centre_, [&](const Vec3& point) {
          const double along = axis_.dot(point);
          return at(along, std::sqrt(std::max(0.0, point.squaredNorm() - along * along)));
        });
  });
}

// Of a disc's edge, curvature matters to first order only: its radius is far above the sharpness.
double disc_share(double x, double y, double radius, const Sharpness& sharpness) {
  if (radius <= 0.0) return 0.0;
  double sum = 0.0;
  for (double dy : sharpness.offsets)
    for (double dx : sharpness.offsets) {
      const double u = (radius - std::hypot(x + dx, y + dy)) / sharpness.sd;
      sum += below(u) - 0.5 * sharpness.sd / radius * density(u);
    }
  return std::clamp(sum / static_cast<double>(sharpness.offsets.size() * sharpness.offsets.size()), 0.0, 1.0);
}

double half_space_share(double depth, const Sharpness& sharpness) {
  double sum = 0.0;
  for (double offset : sharpness.offsets) sum += below((depth + offset) / sharpness.sd);
  return sum / static_cast<double>(sharpness.offsets.size());
}

}  // namespace pendular::phantom
