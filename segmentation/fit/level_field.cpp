#include "segmentation/fit/level_field.h"

#include <Eigen/QR>
#include <cmath>

namespace pendular::segmentation {
namespace {

constexpr Eigen::Index kTerms = 10;
constexpr std::size_t kLeastBalls = 100;

using Terms = Eigen::Matrix<double, kTerms, 1>;

Terms quadratic(const Vec3& p) {
  Terms terms;
  terms << 1.0, p.x(), p.y(), p.z(), p.x() * p.x(), p.y() * p.y(), p.z() * p.z(), p.x() * p.y(),
      p.y() * p.z(), p.z() * p.x();
  return terms;
}

Vec3 slope_of(const Terms& c, const Vec3& p) {
  return {c[1] + 2.0 * c[4] * p.x() + c[7] * p.y() + c[9] * p.z(),
          c[2] + 2.0 * c[5] * p.y() + c[7] * p.x() + c[8] * p.z(),
          c[3] + 2.0 * c[6] * p.z() + c[8] * p.y() + c[9] * p.x()};
}

}  // namespace

void set_level_slopes(std::vector<GreyBall>& balls) {
  if (balls.size() < kLeastBalls) return;
  Vec3 middle = Vec3::Zero();
  for (const GreyBall& ball : balls) middle += ball.centre / static_cast<double>(balls.size());
  double extent = 0.0;
  for (const GreyBall& ball : balls) extent = std::max(extent, (ball.centre - middle).norm());
  const auto place = [&](const GreyBall& ball) { return Vec3((ball.centre - middle) / extent); };
  const auto count = static_cast<Eigen::Index>(balls.size());
  Eigen::Matrix<double, Eigen::Dynamic, kTerms> terms(count, kTerms);
  Eigen::Matrix<double, Eigen::Dynamic, 2> levels(count, 2);
  for (Eigen::Index n = 0; n < count; ++n) {
    const GreyBall& ball = balls[static_cast<std::size_t>(n)];
    terms.row(n) = quadratic(place(ball)).transpose();
    levels.row(n) << ball.contrast, ball.background;
  }
  const Eigen::Matrix<double, kTerms, 2> field = terms.colPivHouseholderQr().solve(levels);
  for (GreyBall& ball : balls) {
    ball.contrast_slope = slope_of(field.col(0), place(ball)) / extent;
    ball.background_slope = slope_of(field.col(1), place(ball)) / extent;
  }
}

}  // namespace pendular::segmentation
