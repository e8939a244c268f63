#include "pipette/spline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pendular::pipette {
namespace {

const double kPole = std::sqrt(3.0) - 2.0;
constexpr int kReach = 32;  // kPole^32 is below 1e-18

int reflect(int k, int size) {
  if (size == 1) return 0;
  const int period = 2 * (size - 1);
  k = ((k % period) + period) % period;
  return k < size ? k : period - k;
}

/// Lines of so many numbers, `stride` apart, that stand side by side: columns of a picture or, with one line,
/// a row of it. Loops are over all lines at each place, so that columns are read as they lie in memory.
struct SideLines {
  double* first;
  int size, stride, lines;

  double* at(int k) const { return first + static_cast<std::ptrdiff_t>(k) * stride; }
};

/// In place: samples to cubic B-spline coefficients, mirrored without repeating the end samples.
void filter(const SideLines& c) {
  const int size = c.size;
  if (size == 1) return;
  for (int k = 0; k < size; ++k)
    for (int l = 0; l < c.lines; ++l) c.at(k)[l] *= 6.0;
  std::vector<double> sums(static_cast<std::size_t>(c.lines), 0.0);
  double power = 1.0;
  for (int k = 0; k < kReach; ++k, power *= kPole)
    for (int l = 0; l < c.lines; ++l) sums[static_cast<std::size_t>(l)] += power * c.at(reflect(k, size))[l];
  std::copy(sums.begin(), sums.end(), c.at(0));
  for (int k = 1; k < size; ++k)
    for (int l = 0; l < c.lines; ++l) c.at(k)[l] += kPole * c.at(k - 1)[l];
  for (int l = 0; l < c.lines; ++l)
    c.at(size - 1)[l] = kPole / (kPole * kPole - 1.0) * (c.at(size - 1)[l] + kPole * c.at(size - 2)[l]);
  for (int k = size - 2; k >= 0; --k)
    for (int l = 0; l < c.lines; ++l) c.at(k)[l] = kPole * (c.at(k + 1)[l] - c.at(k)[l]);
}

struct Weights {
  std::array<double, 4> value, slope;
};

/// Of the coefficients at −1, 0, 1, 2 for a point at t in [0, 1).
Weights weights(double t) {
  const double u = 1.0 - t;
  return {{u * u * u / 6.0, 2.0 / 3.0 - t * t * (1.0 - 0.5 * t), 2.0 / 3.0 - u * u * (1.0 - 0.5 * u),
           t * t * t / 6.0},
          {-0.5 * u * u, t * (1.5 * t - 2.0), u * (2.0 - 1.5 * u), 0.5 * t * t}};
}

/// Half of a Gaussian kernel, from its middle outwards; the whole sums to one.
std::vector<double> gaussian(double sigma) {
  std::vector<double> kernel;
  double sum = 0.0;
  for (int k = 0; k <= static_cast<int>(std::ceil(4.0 * sigma)); ++k) {
    kernel.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += (k == 0 ? 1.0 : 2.0) * kernel.back();
  }
  for (double& w : kernel) w /= sum;
  return kernel;
}

/// In place, mirrored at the ends.
void smooth(const SideLines& values, const std::vector<double>& kernel) {
  const int reach = static_cast<int>(kernel.size()) - 1, lines = values.lines;
  std::vector<double> padded;
  padded.reserve(static_cast<std::size_t>(values.size + 2 * reach) * static_cast<std::size_t>(lines));
  for (int k = -reach; k < values.size + reach; ++k) {
    const double* from = values.at(reflect(k, values.size));
    padded.insert(padded.end(), from, from + lines);
  }
  for (int k = 0; k < values.size; ++k) {
    const double* middle = &padded[static_cast<std::size_t>((k + reach) * lines)];
    double* to = values.at(k);
    for (int l = 0; l < lines; ++l) to[l] = kernel[0] * middle[l];
    for (int j = 1; j <= reach; ++j)
      for (int l = 0; l < lines; ++l)
        to[l] += kernel[static_cast<std::size_t>(j)] * (middle[l + j * lines] + middle[l - j * lines]);
  }
}

}  // namespace

SplineWindow::SplineWindow(const GreyImage& image, const Region& window, double smoothing) {
  x0_ = std::clamp(window.x, 0, image.width - 1);
  y0_ = std::clamp(window.y, 0, image.height - 1);
  width_ = std::clamp(window.x + window.width, x0_ + 1, image.width) - x0_;
  height_ = std::clamp(window.y + window.height, y0_ + 1, image.height) - y0_;
  coefficients_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      coefficients_[static_cast<std::size_t>(y * width_ + x)] = image.at(x0_ + x, y0_ + y);
  const auto row = [&](int y) {
    return SideLines{&coefficients_[static_cast<std::size_t>(y * width_)], width_, 1, 1};
  };
  const SideLines columns = {coefficients_.data(), height_, width_, width_};
  if (smoothing > 0.0) {
    const std::vector<double> kernel = gaussian(smoothing);
    for (int y = 0; y < height_; ++y) smooth(row(y), kernel);
    smooth(columns, kernel);
  }
  for (int y = 0; y < height_; ++y) filter(row(y));
  filter(columns);
}

double SplineWindow::coefficient(int x, int y) const {
  return coefficients_[static_cast<std::size_t>(reflect(y, height_) * width_ + reflect(x, width_))];
}

SplineWindow::Value SplineWindow::at(const Point& point) const {
  const int x = static_cast<int>(std::floor(point.x())), y = static_cast<int>(std::floor(point.y()));
  const Weights wx = weights(point.x() - x), wy = weights(point.y() - y);
  Value result{0.0, 0.0, 0.0};
  for (std::size_t j = 0; j < 4; ++j) {
    double value = 0.0, slope = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double c = coefficient(x - x0_ - 1 + static_cast<int>(i), y - y0_ - 1 + static_cast<int>(j));
      value += wx.value[i] * c;
      slope += wx.slope[i] * c;
    }
    result.value += wy.value[j] * value;
    result.dx += wy.value[j] * slope;
    result.dy += wy.slope[j] * value;
  }
  return result;
}

std::vector<double> SplineWindow::shifted(const std::vector<Eigen::Vector2i>& pixels,
                                          const Point& shift) const {
  const int sx = static_cast<int>(std::floor(shift.x())), sy = static_cast<int>(std::floor(shift.y()));
  const Weights wx = weights(shift.x() - sx), wy = weights(shift.y() - sy);
  std::vector<double> values;
  values.reserve(pixels.size());
  for (const auto& pixel : pixels) {
    const int x = pixel.x() + sx - x0_ - 1, y = pixel.y() + sy - y0_ - 1;
    const bool inside = x >= 0 && y >= 0 && x + 3 < width_ && y + 3 < height_;
    double sum = 0.0;
    for (int j = 0; j < 4; ++j) {
      double row = 0.0;
      if (inside) {
        const double* c = &coefficients_[static_cast<std::size_t>((y + j) * width_ + x)];
        row = wx.value[0] * c[0] + wx.value[1] * c[1] + wx.value[2] * c[2] + wx.value[3] * c[3];
      } else {
        for (int i = 0; i < 4; ++i) row += wx.value[static_cast<std::size_t>(i)] * coefficient(x + i, y + j);
      }
      sum += wy.value[static_cast<std::size_t>(j)] * row;
    }
    values.push_back(sum);
  }
  return values;
}

}  // namespace pendular::pipette
