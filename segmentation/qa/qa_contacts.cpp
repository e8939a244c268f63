#include "segmentation/qa/qa_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "segmentation/fit/ball_profile.h"

namespace pendular::segmentation {
namespace {

constexpr std::size_t kPerBand = 24, kPerRow = 12;
constexpr int kTile = 112, kText = 30, kMargin = 4;  // pixels
constexpr double kAcross = 0.8;                      // half-width of a cut, over the mean radius
const cv::Scalar kGreen(60, 170, 60), kOrange(0, 130, 240), kBlue(220, 130, 40), kDark(40, 40, 40),
    kPaper(255, 255, 255);

/// A plane through the axis of two beads, in voxels.
struct Cut {
  Vec3 middle, along, across;
};

Cut cut_of(const Volume& volume, const Bead& a, const Bead& b) {
  const Vec3 ca = (a.centre - volume.origin) / volume.spacing,
             cb = (b.centre - volume.origin) / volume.spacing;
  const Vec3 along = (cb - ca).normalized();
  const Vec3 other = std::fabs(along.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX();
  const double ra = 0.5 * a.diameter / volume.spacing, rb = 0.5 * b.diameter / volume.spacing;
  return {ca + 0.5 * (ra + (cb - ca).norm() - rb) * along, along,
          (other - other.dot(along) * along).normalized()};
}

/// Grey value between voxels, linearly; nothing outside.
std::optional<double> grey_at(const Volume& volume, const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < 0.0 || p[axis] > static_cast<double>(volume.size[axis]) - 1.001) return std::nullopt;
  return with_pixels(volume, [&](auto pixels) -> std::optional<double> {
    const Vec3 low = p.array().floor();
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      std::array<std::size_t, 3> at{};
      for (int axis = 0; axis < 3; ++axis) {
        const int up = corner >> axis & 1;
        const double share = p[axis] - low[axis];
        weight *= up ? share : 1.0 - share;
        at[static_cast<std::size_t>(axis)] =
            static_cast<std::size_t>(low[axis]) + static_cast<std::size_t>(up);
      }
      if (weight > 0.0)
        sum +=
            weight * static_cast<double>(pixels[(at[2] * volume.size[1] + at[1]) * volume.size[0] + at[0]]);
    }
    return sum;
  });
}

double mean_radius(const Volume& volume, const Segmentation& segmentation) {
  double sum = 0.0;
  for (const Bead& bead : segmentation.beads) sum += 0.5 * bead.diameter / volume.spacing;
  return sum / static_cast<double>(segmentation.beads.size());
}

/// Place of a tile's pixel in its cut.
Vec3 place(const Cut& cut, double half, int row, int column) {
  const double step = 2.0 * half / kTile;
  return cut.middle + ((column + 0.5) * step - half) * cut.along + (half - (row + 0.5) * step) * cut.across;
}

cv::Mat tile_of(const Volume& volume, const Segmentation& segmentation, const Bridge& pair,
                const cv::Scalar& colour) {
  const Cut cut = cut_of(volume, segmentation.beads[pair.i], segmentation.beads[pair.j]);
  const double half = kAcross * mean_radius(volume, segmentation);
  const auto& levels = segmentation.levels;
  cv::Mat tile(kTile + kText, kTile, CV_8UC3, kPaper);
  for (int row = 0; row < kTile; ++row)
    for (int column = 0; column < kTile; ++column) {
      const auto grey = grey_at(volume, place(cut, half, row, column));
      const double share = grey ? 0.1 + 0.8 * (*grey - levels.dark) / (levels.bright - levels.dark) : 0.0;
      const auto level = cv::saturate_cast<std::uint8_t>(255.0 * share);
      tile.at<cv::Vec3b>(row, column) = {level, level, level};
    }
  cv::rectangle(tile, {0, 0}, {kTile - 1, kTile - 1}, colour, 2);
  const auto text = [&](const std::string& words, int y) {
    cv::putText(tile, words, {2, kTile + y}, cv::FONT_HERSHEY_SIMPLEX, 0.36, kDark, 1, cv::LINE_AA);
  };
  text(fmt::format("p {:.3f}  gap {:.1f}", pair.probability, std::round(1e7 * pair.gap) / 10.0 + 0.0), 12);
  if (pair.diameter > 0.0)
    text(fmt::format("d {:.1f} +- {:.1f}", 1e6 * pair.diameter, 1e6 * pair.sigma_diameter), 25);
  return tile;
}

/// Evenly spread over a sorted list.
std::vector<Bridge> some_of(std::vector<Bridge> pairs, const std::function<double(const Bridge&)>& order) {
  std::sort(pairs.begin(), pairs.end(),
            [&](const Bridge& a, const Bridge& b) { return order(a) < order(b); });
  if (pairs.size() <= kPerBand) return pairs;
  std::vector<Bridge> some;
  for (std::size_t k = 0; k < kPerBand; ++k) some.push_back(pairs[k * (pairs.size() - 1) / (kPerBand - 1)]);
  return some;
}

std::vector<Bridge> in_state(const Segmentation& segmentation, BridgeState state) {
  std::vector<Bridge> found;
  for (const auto& pair : segmentation.bridges)
    if (pair.state == state) found.push_back(pair);
  return found;
}

/// Those whose probability is nearest a half.
std::vector<Bridge> doubtful(const Segmentation& segmentation) {
  auto pairs = segmentation.bridges;
  const auto doubt = [](const Bridge& pair) { return std::fabs(pair.probability - 0.5); };
  std::sort(pairs.begin(), pairs.end(),
            [&](const Bridge& a, const Bridge& b) { return doubt(a) < doubt(b); });
  pairs.resize(std::min(pairs.size(), kPerBand));
  return pairs;
}

void add_band(cv::Mat& image, int top, const std::vector<Bridge>& pairs, const std::string& title,
              const cv::Scalar& colour, const Volume& volume, const Segmentation& segmentation) {
  cv::putText(image, title, {kMargin, top + 18}, cv::FONT_HERSHEY_SIMPLEX, 0.5, kDark, 1, cv::LINE_AA);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const cv::Mat tile = tile_of(volume, segmentation, pairs[k], colour);
    const int x = kMargin + static_cast<int>(k % kPerRow) * (kTile + kMargin),
              y = top + 26 + static_cast<int>(k / kPerRow) * (kTile + kText + kMargin);
    tile.copyTo(image(cv::Rect(x, y, tile.cols, tile.rows)));
  }
}

/// Mean of what the beads leave, over pairs in a state; empty where there are none.
cv::Mat mean_residual(const Volume& volume, const Segmentation& segmentation, BridgeState state) {
  constexpr std::size_t most = 2000;
  const auto pairs = in_state(segmentation, state);
  const std::size_t step = pairs.size() / most + 1;
  const double half = kAcross * mean_radius(volume, segmentation), blur = segmentation.blur / volume.spacing;
  const auto& levels = segmentation.levels;
  const double edge = (segmentation.bright_beads ? 1.0 : -1.0) * (levels.bright - levels.dark);
  const double base = segmentation.bright_beads ? levels.dark : levels.bright;
  cv::Mat sum(kTile, kTile, CV_64FC1, cv::Scalar(0.0));
  double count = 0.0;
  for (std::size_t k = 0; k < pairs.size(); k += step) {
    const Bead &a = segmentation.beads[pairs[k].i], &b = segmentation.beads[pairs[k].j];
    const Cut cut = cut_of(volume, a, b);
    cv::Mat own(kTile, kTile, CV_64FC1);
    bool whole = true;
    for (int row = 0; row < kTile && whole; ++row)
      for (int column = 0; column < kTile && whole; ++column) {
        const Vec3 p = place(cut, half, row, column);
        const auto grey = grey_at(volume, p);
        whole = grey.has_value();
        if (!whole) break;
        double share = (*grey - base) / edge;
        for (const Bead* bead : {&a, &b}) {
          const double r = (p - (bead->centre - volume.origin) / volume.spacing).norm();
          share -= ball_profile(std::max(r, 0.1), 0.5 * bead->diameter / volume.spacing, blur).value;
        }
        own.at<double>(row, column) = share;
      }
    if (whole) sum += own, count += 1.0;
  }
  if (count == 0.0) return {};
  cv::Mat image;
  sum.convertTo(image, CV_8UC1, 255.0 / count, 127.5);
  cv::resize(image, image, {}, 4.0, 4.0, cv::INTER_NEAREST);
  return image;
}

}  // namespace

cv::Mat contact_montage(const Volume& volume, const Segmentation& segmentation) {
  const int band = 26 + 2 * (kTile + kText + kMargin) + 10;
  cv::Mat image(3 * band, kMargin + static_cast<int>(kPerRow) * (kTile + kMargin), CV_8UC3, kPaper);
  add_band(image, 0,
           some_of(in_state(segmentation, BridgeState::bridge), [](const Bridge& b) { return b.diameter; }),
           "bridges, by diameter (um)", kGreen, volume, segmentation);
  add_band(image, band, doubtful(segmentation), "the most doubtful", kOrange, volume, segmentation);
  add_band(image, 2 * band,
           some_of(in_state(segmentation, BridgeState::none), [](const Bridge& b) { return b.gap; }),
           "without a bridge, by gap", kBlue, volume, segmentation);
  return image;
}

cv::Mat mean_residuals(const Volume& volume, const Segmentation& segmentation) {
  const int side = 4 * kTile;
  cv::Mat image(side + 30, 2 * side + 20, CV_8UC3, kPaper);
  int x = 0;
  for (const auto& [state, title] : {std::pair(BridgeState::bridge, "mean over bridges, less both beads"),
                                     {BridgeState::none, "mean over pairs without"}}) {
    cv::putText(image, title, {x + 4, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.5, kDark, 1, cv::LINE_AA);
    if (const cv::Mat grey = mean_residual(volume, segmentation, state); !grey.empty()) {
      cv::Mat colour;
      cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
      colour.copyTo(image(cv::Rect(x, 30, side, side)));
    }
    x += side + 20;
  }
  return image;
}

cv::Mat recovery_curve(const std::vector<InjectedNecks>& injected) {
  constexpr int width = 520, height = 340, left = 60, base = 280, tall = 230, wide = 420;
  cv::Mat image(height, width, CV_8UC3, kPaper);
  const auto text = [&](const std::string& words, int x, int y) {
    cv::putText(image, words, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kDark, 1, cv::LINE_AA);
  };
  double largest = 0.0;
  for (const auto& size : injected) largest = std::max(largest, 1.1 * size.diameter);
  const auto at = [&](double diameter, double share) {
    return cv::Point(left + static_cast<int>(std::lround(wide * diameter / largest)),
                     base - static_cast<int>(std::lround(tall * share)));
  };
  for (const double share : {0.0, 0.5, 0.95, 1.0}) {
    cv::line(image, at(0.0, share), at(largest, share), {225, 225, 225}, 1);
    text(fmt::format("{:.2f}", share), 14, at(0.0, share).y + 5);
  }
  std::optional<cv::Point> before;
  for (const auto& size : injected) {
    if (size.injected == 0) continue;
    const cv::Point here = at(size.diameter, size.found);
    if (before) cv::line(image, *before, here, kGreen, 2, cv::LINE_AA);
    cv::circle(image, here, 4, kGreen, cv::FILLED, cv::LINE_AA);
    text(fmt::format("{:.0f}", 1e6 * size.diameter), here.x - 10, base + 18);
    before = here;
  }
  text("share of injected necks that were found, over their diameter (um)", left - 40, 24);
  return image;
}

}  // namespace pendular::segmentation
