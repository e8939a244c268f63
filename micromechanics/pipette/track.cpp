#include "pipette/track.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "pipette/spline.h"

namespace pendular::pipette {
namespace {

constexpr int kRim = 18;        // of the spline window: its mirrored rim has died out by then
constexpr double kStep = 1e-5;  // pixels, at which the steps end
constexpr int kMostSteps = 40;
constexpr double kSmoothing = 1.0;  // pixels: about a microscope's point spread
constexpr double kFlat = 1e-4;      // grey over full scale: less contrast than this is none

/// Subtracts the mean, divides by the norm; returns the norm.
double normalise(std::vector<double>& values) {
  double mean = 0.0, norm = 0.0;
  for (double v : values) mean += v;
  mean /= static_cast<double>(values.size());
  for (double& v : values) {
    v -= mean;
    norm += v * v;
  }
  norm = std::sqrt(norm);
  if (norm > 0.0)
    for (double& v : values) v /= norm;
  return norm;
}

cv::Mat to_float(const GreyImage& image, const Region& box) {
  cv::Mat result(box.height, box.width, CV_32F);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      result.at<float>(y, x) = static_cast<float>(image.at(box.x + x, box.y + y));
  return result;
}

/// Best whole-pixel displacement within `reach` of the guess; false where the image does not hold the search.
bool search(const Template& wanted, const GreyImage& image, const Point& guess, int reach, Point& found) {
  const int gx = static_cast<int>(std::lround(guess.x())), gy = static_cast<int>(std::lround(guess.y()));
  const Region& box = wanted.box;
  const int left = std::max(box.x + gx - reach, 0), top = std::max(box.y + gy - reach, 0);
  const int right = std::min(box.x + gx + box.width + reach, image.width);
  const int bottom = std::min(box.y + gy + box.height + reach, image.height);
  if (right - left < box.width || bottom - top < box.height) return false;
  cv::Mat scores;
  cv::matchTemplate(to_float(image, {left, top, right - left, bottom - top}),
                    to_float(wanted.patch, {0, 0, box.width, box.height}), scores, cv::TM_CCOEFF_NORMED,
                    to_float(wanted.mask, {0, 0, box.width, box.height}));
  double best = -2.0;
  for (int y = 0; y < scores.rows; ++y)
    for (int x = 0; x < scores.cols; ++x) {
      const double score = scores.at<float>(y, x);
      // Flat parts of a frame give no number, or one without meaning.
      if (!std::isfinite(score) || std::abs(score) > 1.01 || score <= best) continue;
      best = score;
      found = {left + x - box.x, top + y - box.y};
    }
  return best > -2.0;
}

bool holds(const GreyImage& image, const Region& box, const Point& shift) {
  return box.x + shift.x() > -0.5 && box.y + shift.y() > -0.5 &&
         box.x + box.width - 1 + shift.x() < image.width - 0.5 &&
         box.y + box.height - 1 + shift.y() < image.height - 0.5;
}

}  // namespace

Template make_template(const GreyImage& image, const Region& box,
                       const std::function<bool(const Point&)>& wanted) {
  Template result;
  result.box = box;
  result.patch = GreyImage(box.width, box.height);
  result.mask = GreyImage(box.width, box.height);
  const SplineWindow spline(image, {box.x - kRim, box.y - kRim, box.width + 2 * kRim, box.height + 2 * kRim},
                            kSmoothing);
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      const Point point(box.x + x, box.y + y);
      result.patch.at(x, y) = image.at(box.x + x, box.y + y);
      if (wanted && !wanted(point)) continue;
      result.mask.at(x, y) = 1.0;
      const auto value = spline.at(point);
      result.pixels.emplace_back(box.x + x, box.y + y);
      result.values.push_back(value.value);
      result.gradients.emplace_back(value.dx, value.dy);
      hessian += result.gradients.back() * result.gradients.back().transpose();
    }
  if (result.pixels.empty()) return result;
  result.norm = normalise(result.values);
  const double pixels = static_cast<double>(result.pixels.size());
  if (result.norm < kFlat * std::sqrt(pixels) ||
      hessian.determinant() < 1e-6 * hessian.trace() * hessian.trace())
    result.norm = 0.0;
  else
    result.inverse_hessian = hessian.inverse();
  return result;
}

Match match(const Template& wanted, const GreyImage& image, const Point& guess, int reach) {
  Match result;
  Point shift;
  if (!search(wanted, image, guess, reach, shift)) return result;
  const Point start = shift;
  const Region& box = wanted.box;
  const SplineWindow spline(
      image,
      {box.x + static_cast<int>(shift.x()) - kRim, box.y + static_cast<int>(shift.y()) - kRim,
       box.width + 2 * kRim, box.height + 2 * kRim},
      kSmoothing);
  for (int step = 0; step < kMostSteps; ++step) {
    std::vector<double> values = spline.shifted(wanted.pixels, shift);
    if (normalise(values) == 0.0) return result;
    Point gradient = Point::Zero();
    double score = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      gradient += (wanted.values[k] - values[k]) * wanted.gradients[k];
      score += wanted.values[k] * values[k];
    }
    const Point change = wanted.norm * (wanted.inverse_hessian * gradient);
    result.displacement = shift;
    result.score = score;
    shift += change;
    if ((shift - start).cwiseAbs().maxCoeff() > 3.0 || !holds(image, box, shift)) return result;
    if (change.norm() < kStep) {
      result.displacement = shift;
      result.found = true;
      return result;
    }
  }
  return result;
}

}  // namespace pendular::pipette
