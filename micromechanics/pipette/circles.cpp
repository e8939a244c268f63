#include "pipette/circles.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/quantile.h"
#include "pipette/spline.h"

namespace pendular::pipette {
namespace {

constexpr int kRadii = 180;
constexpr double kProfileStep = 0.25;  // pixels
constexpr double kFaintStep = 0.01;    // grey per pixel: a fainter edge is none
constexpr double kAwayFromNeighbour = 50.0 * M_PI / 180.0;

/// Grey step per pixel along a line, averaged over one pixel of it.
std::vector<double> slopes(const SplineWindow& spline, const Point& from, const Point& along, double length) {
  std::vector<double> result;
  for (int k = 0; k * kProfileStep <= length; ++k) {
    const double s = k * kProfileStep;
    result.push_back(spline.at(from + (s + 0.5) * along).value - spline.at(from + (s - 0.5) * along).value);
  }
  return result;
}

struct Step {
  double position, height;  ///< pixels along the line; grey per pixel, signed
};

/// The steepest step, rising with `sign` 1, falling with −1, either with 0; its place by a parabola.
std::optional<Step> steepest(const std::vector<double>& slope, double sign) {
  std::size_t best = 0;
  double height = 0.0;
  for (std::size_t k = 1; k + 1 < slope.size(); ++k) {
    const double h = sign == 0.0 ? std::abs(slope[k]) : sign * slope[k];
    if (h > height && std::abs(slope[k]) >= std::abs(slope[k - 1]) &&
        std::abs(slope[k]) >= std::abs(slope[k + 1])) {
      height = h;
      best = k;
    }
  }
  if (height < kFaintStep) return std::nullopt;
  const double bend = slope[best - 1] - 2.0 * slope[best] + slope[best + 1];
  const double offset = bend == 0.0 ? 0.0 : 0.5 * (slope[best - 1] - slope[best + 1]) / bend;
  return Step{kProfileStep * (static_cast<double>(best) + std::clamp(offset, -1.0, 1.0)), slope[best]};
}

std::optional<Circle> kasa(const std::vector<Point>& points) {
  Point mean = Point::Zero();
  for (const Point& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Point& p : points) {
    const Eigen::Vector3d row(p.x() - mean.x(), p.y() - mean.y(), 1.0);
    normal += row * row.transpose();
    right += (p - mean).squaredNorm() * row;
  }
  const Eigen::Vector3d v = normal.ldlt().solve(right);
  Circle circle;
  circle.centre = mean + 0.5 * v.head<2>();
  const double square = v.z() + 0.25 * v.head<2>().squaredNorm();
  if (!(square > 0.0) || !std::isfinite(square)) return std::nullopt;
  circle.radius = std::sqrt(square);
  return circle;
}

/// Gauss–Newton on the distances; fills the sigmas.
void refine(Circle& circle, const std::vector<Point>& points) {
  Eigen::Matrix3d normal;
  double squares = 0.0;
  for (int step = 0; step < 20; ++step) {
    normal.setZero();
    squares = 0.0;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Point& p : points) {
      const Point out = p - circle.centre;
      const double distance = std::max(out.norm(), 1e-12), residual = distance - circle.radius;
      const Eigen::Vector3d row(out.x() / distance, out.y() / distance, 1.0);
      normal += row * row.transpose();
      right += residual * row;
      squares += residual * residual;
    }
    const Eigen::Vector3d change = normal.ldlt().solve(right);
    circle.centre += change.head<2>();
    circle.radius += change.z();
    if (change.norm() < 1e-9) break;
  }
  circle.scatter = std::sqrt(squares / std::max(1.0, static_cast<double>(points.size()) - 3.0));
  circle.radius_sigma = circle.scatter * std::sqrt(std::max(0.0, normal.inverse()(2, 2)));
  circle.edge = points;
}

}  // namespace

std::optional<Circle> fit_circle(const std::vector<Point>& points) {
  std::vector<Point> kept = points;
  std::optional<Circle> circle;
  for (int round = 0; round < 8; ++round) {
    if (kept.size() < 12) return std::nullopt;
    circle = kasa(kept);
    if (!circle) return std::nullopt;
    refine(*circle, kept);
    std::vector<double> off;
    for (const Point& p : points) off.push_back(std::abs((p - circle->centre).norm() - circle->radius));
    const double limit = std::max(0.3, 3.0 * 1.4826 * median(off));
    std::vector<Point> next;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (off[k] <= limit) next.push_back(points[k]);
    if (next.size() == kept.size()) break;
    kept = std::move(next);
  }
  return circle;
}

std::optional<Circle> find_outline(const GreyImage& image, const Point& centre, double radius,
                                   const Point& neighbour) {
  const SplineWindow spline(image, {0, 0, image.width, image.height});
  const double from = 0.65 * radius, length = 0.7 * radius;
  const double towards = std::atan2(neighbour.y() - centre.y(), neighbour.x() - centre.x());
  std::vector<std::pair<Point, std::vector<double>>> lines;  // direction, slopes along it
  double balance = 0.0;
  for (int k = 0; k < kRadii; ++k) {
    const double angle = 2.0 * M_PI * k / kRadii;
    const Point out(std::cos(angle), std::sin(angle)), end = centre + (from + length) * out;
    if (std::abs(std::remainder(angle - towards, 2.0 * M_PI)) < kAwayFromNeighbour) continue;
    if (end.x() < 0.0 || end.y() < 0.0 || end.x() > image.width - 1 || end.y() > image.height - 1) continue;
    lines.emplace_back(out, slopes(spline, centre + from * out, out, length));
    if (const auto step = steepest(lines.back().second, 0.0)) balance += step->height;
  }
  std::vector<Point> edge;
  for (const auto& [out, slope] : lines)
    if (const auto step = steepest(slope, balance > 0.0 ? 1.0 : -1.0))
      edge.push_back(centre + (from + step->position) * out);
  auto circle = fit_circle(edge);
  if (!circle || 2 * circle->edge.size() < edge.size() || circle->scatter > 0.05 * circle->radius)
    return std::nullopt;
  return circle;
}

std::optional<std::array<Circle, 2>> find_two_beads(const GreyImage& image, double radius) {
  cv::Mat picture(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      picture.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(255.0 * image.at(x, y)));
  cv::GaussianBlur(picture, picture, {}, 1.2);
  std::vector<cv::Vec3f> found;
  cv::HoughCircles(picture, found, cv::HOUGH_GRADIENT, 1.0, 0.5 * radius, 80.0, 12.0,
                   static_cast<int>(0.75 * radius), static_cast<int>(std::ceil(1.25 * radius)));
  std::vector<Circle> circles;
  for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 12); ++k)
    if (auto circle = find_outline(image, {found[k][0], found[k][1]}, found[k][2], {1e9, 0.0}))
      if (std::abs(circle->radius / radius - 1.0) < 0.25) circles.push_back(std::move(*circle));
  std::optional<std::array<Circle, 2>> best;
  double least = 0.15 * radius;  // two beads of one bridge nearly touch
  for (std::size_t a = 0; a < circles.size(); ++a)
    for (std::size_t b = a + 1; b < circles.size(); ++b) {
      const double distance = (circles[a].centre - circles[b].centre).norm();
      const double misfit = std::abs(distance - circles[a].radius - circles[b].radius);
      if (misfit >= least) continue;
      least = misfit;
      const bool in_order = circles[a].centre.x() + 1e-3 * circles[a].centre.y() <
                            circles[b].centre.x() + 1e-3 * circles[b].centre.y();
      best = in_order ? std::array{circles[a], circles[b]} : std::array{circles[b], circles[a]};
    }
  if (!best) return std::nullopt;
  for (std::size_t k = 0; k < 2; ++k) {
    const Circle &bead = (*best)[k], &other = (*best)[1 - k];
    if (auto better = find_outline(image, bead.centre, bead.radius, other.centre)) (*best)[k] = *better;
  }
  return best;
}

std::optional<Neck> find_neck(const GreyImage& image, const Circle& bead, const Circle& other) {
  const SplineWindow spline(image, {0, 0, image.width, image.height});
  const Point axis = (other.centre - bead.centre).normalized(), across(-axis.y(), axis.x());
  const double gap = (other.centre - bead.centre).norm() - bead.radius - other.radius;
  const Point middle = bead.centre + (bead.radius + 0.5 * gap) * axis;
  const double length = std::min(bead.radius, other.radius);
  std::vector<double> diameters;
  Neck neck;
  for (int line = -1; line <= 1; ++line) {
    const Point start = middle + line * axis;
    const auto up = slopes(spline, start, across, length), down = slopes(spline, start, -across, length);
    const auto a = steepest(up, 0.0), b = steepest(down, 0.0);
    if (!a || !b || a->height * b->height < 0.0) return std::nullopt;
    diameters.push_back(a->position + b->position);
    if (line == 0) {
      neck.a = start + a->position * across;
      neck.b = start - b->position * across;
    }
  }
  for (double d : diameters) neck.diameter += d / 3.0;
  for (double d : diameters)
    neck.sigma += (d - neck.diameter) * (d - neck.diameter) / 6.0;  // of their mean: /2/3
  neck.sigma = std::sqrt(neck.sigma);
  return neck;
}

}  // namespace pendular::pipette
