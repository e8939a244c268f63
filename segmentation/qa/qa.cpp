#include "segmentation/qa/qa.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "segmentation/fit/ball_profile.h"
#include "segmentation/qa/qa_contacts.h"
#include "segmentation/qa/qa_radii.h"
#include "volume/image_io.h"

namespace pendular::segmentation {
namespace {

/// A plane of the volume: horizontal axis x, vertical axis y or z (upwards), at voxel `level` of the third.
struct Plane {
  int vertical = 1;  ///< 1: y, 2: z
  std::size_t level = 0;
  int normal() const { return 3 - vertical; }
};

double pixel(const Volume& volume, const Plane& plane, std::size_t a, std::size_t b) {
  std::array<std::size_t, 3> at{a, 0, 0};
  at[static_cast<std::size_t>(plane.vertical)] = b;
  at[static_cast<std::size_t>(plane.normal())] = plane.level;
  const std::size_t n = (at[2] * volume.size[1] + at[1]) * volume.size[0] + at[0];
  return with_pixels(volume, [&](auto pixels) { return static_cast<double>(pixels[n]); });
}

/// The plane as a grey picture, z or y upwards; 0.1 of the range is left on both sides of the two classes.
cv::Mat picture(const Volume& volume, const Plane& plane,
                const std::function<double(std::size_t, std::size_t)>& share) {
  const auto width = static_cast<int>(volume.size[0]),
             height = static_cast<int>(volume.size[static_cast<std::size_t>(plane.vertical)]);
  cv::Mat image(height, width, CV_8UC1);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      image.at<std::uint8_t>(row, column) = cv::saturate_cast<std::uint8_t>(
          255.0 * share(static_cast<std::size_t>(column), static_cast<std::size_t>(height - 1 - row)));
  return image;
}

/// Circles are drawn on the picture enlarged to at least this many pixels across.
constexpr int least_pixels = 900;

struct Drawing {
  cv::Mat image;
  double scale = 1.0, height = 0.0;

  explicit Drawing(const cv::Mat& grey) : height(grey.rows) {
    scale = std::max(1.0, std::ceil(static_cast<double>(least_pixels) / std::max(grey.rows, grey.cols)));
    cv::Mat large;
    cv::resize(grey, large, {}, scale, scale, cv::INTER_NEAREST);
    cv::cvtColor(large, image, cv::COLOR_GRAY2BGR);
  }

  /// Position in sixteenths of a pixel.
  cv::Point at(double x, double y) const {
    const auto place = [&](double v) {
      return static_cast<int>(std::lround(16.0 * ((v + 0.5) * scale - 0.5)));
    };
    return {place(x), place(height - 1.0 - y)};
  }
  void circle(double x, double y, double radius, const cv::Scalar& colour) {
    cv::circle(image, at(x, y), static_cast<int>(std::lround(16.0 * radius * scale)), colour, 1, cv::LINE_AA,
               4);
  }
  void line(double x0, double y0, double x1, double y1, const cv::Scalar& colour) {
    cv::line(image, at(x0, y0), at(x1, y1), colour, 1, cv::LINE_AA, 4);
  }
};

const cv::Scalar green(60, 220, 60), orange(0, 140, 255), blue(255, 150, 60), dark(40, 40, 40),
    pale(225, 225, 225);

void write_png(const fs::path& path, const cv::Mat& image) {
  cv::Mat rgb;
  cv::cvtColor(image, rgb, image.channels() == 1 ? cv::COLOR_GRAY2RGB : cv::COLOR_BGR2RGB);
  pendular::write_png(path, static_cast<std::size_t>(rgb.cols), static_cast<std::size_t>(rgb.rows),
                      {rgb.data, rgb.total() * 3});
}

void draw_specimen(Drawing& drawing, const Volume& volume, const Plane& plane, const Specimen& specimen) {
  const double h = volume.spacing, radius = 0.5 * specimen.diameter / h;
  const double x = (specimen.axis_x - volume.origin.x()) / h, y = (specimen.axis_y - volume.origin.y()) / h;
  const double bottom = (specimen.bottom - volume.origin.z()) / h, top = bottom + specimen.height / h;
  if (plane.vertical == 1) {
    drawing.circle(x, y, radius, blue);
    return;
  }
  const double off = static_cast<double>(plane.level) - y;
  if (std::abs(off) >= radius) return;
  const double half = std::sqrt(radius * radius - off * off);
  drawing.line(x - half, bottom, x + half, bottom, blue);
  drawing.line(x - half, top, x + half, top, blue);
  drawing.line(x - half, bottom, x - half, top, blue);
  drawing.line(x + half, bottom, x + half, top, blue);
}

cv::Mat overlay(const Volume& volume, const Segmentation& segmentation, const Plane& plane) {
  const GreyLevels& levels = segmentation.levels;
  Drawing drawing(picture(volume, plane, [&](std::size_t a, std::size_t b) {
    return 0.1 + 0.8 * (pixel(volume, plane, a, b) - levels.dark) / (levels.bright - levels.dark);
  }));
  for (const Bead& bead : segmentation.beads) {
    const Vec3 c = (bead.centre - volume.origin) / volume.spacing;
    const double radius = 0.5 * bead.diameter / volume.spacing,
                 off = static_cast<double>(plane.level) - c[plane.normal()];
    if (std::abs(off) < radius)
      drawing.circle(c.x(), c[plane.vertical], std::sqrt(radius * radius - off * off),
                     bead.quality < 0.5 ? orange : green);
  }
  if (segmentation.specimen) draw_specimen(drawing, volume, plane, *segmentation.specimen);
  return drawing.image;
}

cv::Mat residual(const Volume& volume, const Segmentation& segmentation, const Plane& plane) {
  const GreyLevels& levels = segmentation.levels;
  const double edge = levels.bright - levels.dark, blur = segmentation.blur / volume.spacing;
  const auto width = static_cast<int>(volume.size[0]),
             height = static_cast<int>(volume.size[static_cast<std::size_t>(plane.vertical)]);
  cv::Mat model(height, width, CV_64FC1, cv::Scalar(0.0));
  for (const Bead& bead : segmentation.beads) {
    const Vec3 c = (bead.centre - volume.origin) / volume.spacing;
    const double radius = 0.5 * bead.diameter / volume.spacing, reach = radius + 4.0 * blur;
    const double off = static_cast<double>(plane.level) - c[plane.normal()];
    if (std::abs(off) > reach) continue;
    for (int b = std::max(0, static_cast<int>(c[plane.vertical] - reach));
         b < std::min(height, static_cast<int>(c[plane.vertical] + reach) + 2); ++b)
      for (int a = std::max(0, static_cast<int>(c.x() - reach));
           a < std::min(width, static_cast<int>(c.x() + reach) + 2); ++a) {
        const double r = std::sqrt(off * off + std::pow(a - c.x(), 2) + std::pow(b - c[plane.vertical], 2));
        if (r < reach) model.at<double>(b, a) += ball_profile(std::max(r, 0.1), radius, blur).value;
      }
  }
  const double base = segmentation.bright_beads ? levels.dark : levels.bright,
               sign = segmentation.bright_beads ? 1.0 : -1.0;
  return picture(volume, plane, [&](std::size_t a, std::size_t b) {
    const double modelled = base + sign * edge * model.at<double>(static_cast<int>(b), static_cast<int>(a));
    return 0.5 + 0.5 * (pixel(volume, plane, a, b) - modelled) / edge;
  });
}

/// One panel per axis.
cv::Mat fractional_positions(const Volume& volume, const std::vector<Bead>& beads) {
  constexpr int bins = 20, bar = 16, panel = bins * bar + 60, height = 320, base = 270, tall = 200;
  cv::Mat image(height, 3 * panel, CV_8UC3, cv::Scalar(255, 255, 255));
  const double mean = static_cast<double>(beads.size()) / bins, band = 2.0 * std::sqrt(mean);
  for (int axis = 0; axis < 3; ++axis) {
    std::array<int, bins> counts{};
    for (const Bead& bead : beads) {
      const double voxel = (bead.centre[axis] - volume.origin[axis]) / volume.spacing;
      ++counts[static_cast<std::size_t>(std::min(bins - 1.0, bins * (voxel - std::floor(voxel))))];
    }
    const double highest =
        std::max(mean + band, static_cast<double>(*std::max_element(counts.begin(), counts.end())));
    const auto level = [&](double count) {
      return base - static_cast<int>(std::lround(tall * std::max(0.0, count) / highest));
    };
    const int left = axis * panel + 40;
    cv::rectangle(image, {left, level(mean + band)}, {left + bins * bar, level(mean - band)}, pale,
                  cv::FILLED);
    for (int n = 0; n < bins; ++n)
      cv::rectangle(image, {left + n * bar + 1, level(counts[static_cast<std::size_t>(n)])},
                    {left + (n + 1) * bar - 2, base}, blue, cv::FILLED);
    cv::line(image, {left, base}, {left + bins * bar, base}, dark, 1);
    const auto text = [&](const std::string& words, int x, int y) {
      cv::putText(image, words, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.5, dark, 1, cv::LINE_AA);
    };
    text(fmt::format("{} within its voxel, {} beads", "xyz"[axis], beads.size()), left, 40);
    text("0", left - 4, base + 20);
    text("1", left + bins * bar - 4, base + 20);
    text(fmt::format("{:.0f}", highest), left - 36, level(highest) + 5);
  }
  return image;
}

/// The planes at a quarter, a half and three quarters of the beads' extent.
std::vector<Plane> planes(const Volume& volume, const std::vector<Bead>& beads, int vertical) {
  const int normal = 3 - vertical;
  double low = beads.front().centre[normal], high = low;
  for (const Bead& bead : beads) {
    low = std::min(low, bead.centre[normal]);
    high = std::max(high, bead.centre[normal]);
  }
  std::vector<Plane> result;
  for (const double share : {0.25, 0.5, 0.75}) {
    const double voxel = (low + share * (high - low) - volume.origin[normal]) / volume.spacing;
    const double last = static_cast<double>(volume.size[static_cast<std::size_t>(normal)] - 1);
    result.push_back({vertical, static_cast<std::size_t>(std::clamp(std::round(voxel), 0.0, last))});
  }
  return result;
}

}  // namespace

void write_qa(const fs::path& folder, const Volume& volume, const Segmentation& segmentation) {
  make_folder(folder);
  if (segmentation.beads.empty()) return;
  for (const int vertical : {1, 2}) {
    const std::string name = vertical == 1 ? "xy" : "xz";
    const auto cuts = planes(volume, segmentation.beads, vertical);
    for (std::size_t n = 0; n < cuts.size(); ++n)
      write_png(folder / fmt::format("slice_{}_{}.png", name, n + 1), overlay(volume, segmentation, cuts[n]));
    write_png(folder / fmt::format("residual_{}.png", name), residual(volume, segmentation, cuts[1]));
  }
  write_png(folder / "fractional_positions.png", fractional_positions(volume, segmentation.beads));
  write_png(folder / "diameters.png", radius_map(volume, segmentation));
  if (!segmentation.measured) return;
  write_png(folder / "contacts.png", contact_montage(volume, segmentation));
  write_png(folder / "mean_residuals.png", mean_residuals(volume, segmentation));
  if (!segmentation.measured->injected.empty())
    write_png(folder / "recovery.png", recovery_curve(segmentation.measured->injected));
}

}  // namespace pendular::segmentation
