#include "segmentation/qa/qa_radii.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace pendular::segmentation {
namespace {

constexpr int kRings = 5, kLayers = 8, kCell = 110, kLeft = 90, kTop = 70, kFoot = 60;

const cv::Scalar kInk(40, 40, 40);

void write(cv::Mat& image, const std::string& words, int x, int y, double size = 0.45) {
  cv::putText(image, words, {x, y}, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

/// White at zero, red at one, blue at minus one.
cv::Scalar colour_of(double share) {
  const double pale = 255.0 * (1.0 - std::min(1.0, std::fabs(share)));
  return share > 0.0 ? cv::Scalar(pale, pale, 255.0) : cv::Scalar(255.0, pale, pale);
}

struct Cell {
  double sum = 0.0, count = 0.0;
};

/// Rings of equal area about the axis of the container, or of all beads; layers of equal height.
struct Cells {
  std::array<std::array<Cell, kRings>, kLayers> at;
  double radius = 0.0, low = 0.0, high = 0.0;
};

Cells cells_of(const std::vector<Bead>& beads, const std::optional<Specimen>& specimen, double expected) {
  Cells cells;
  double x = 0.0, y = 0.0;
  cells.low = cells.high = beads.front().centre.z();
  for (const Bead& bead : beads) {
    x += bead.centre.x() / static_cast<double>(beads.size());
    y += bead.centre.y() / static_cast<double>(beads.size());
    cells.low = std::min(cells.low, bead.centre.z()), cells.high = std::max(cells.high, bead.centre.z());
  }
  if (specimen) x = specimen->axis_x, y = specimen->axis_y;
  const auto from_axis = [&](const Bead& bead) {
    return std::hypot(bead.centre.x() - x, bead.centre.y() - y);
  };
  for (const Bead& bead : beads) cells.radius = std::max(cells.radius, from_axis(bead));
  const auto place = [](double share, int count) {
    return static_cast<std::size_t>(std::clamp(std::floor(share * count), 0.0, count - 1.0));
  };
  for (const Bead& bead : beads) {
    const double out = cells.radius > 0.0 ? from_axis(bead) / cells.radius : 0.0,
                 up = cells.high > cells.low ? (bead.centre.z() - cells.low) / (cells.high - cells.low) : 0.0;
    Cell& cell = cells.at[place(up, kLayers)][place(out * out, kRings)];
    cell.sum += bead.diameter - expected, cell.count += 1.0;
  }
  return cells;
}

}  // namespace

cv::Mat radius_map(const Volume& volume, const Segmentation& segmentation) {
  std::vector<double> diameters;
  for (const Bead& bead : segmentation.beads) diameters.push_back(bead.diameter);
  std::sort(diameters.begin(), diameters.end());
  const std::size_t last = diameters.size() - 1;
  const double expected = diameters[last / 2];
  // Half the width of the middle two thirds: the spread of the beads without the odd ones.
  const double spread = 0.5 * (diameters[last * 5 / 6] - diameters[last / 6]);
  const Cells cells = cells_of(segmentation.beads, segmentation.specimen, expected);
  cv::Mat image(kTop + kLayers * kCell / 2 + kFoot, kLeft + kRings * kCell + 30, CV_8UC3,
                cv::Scalar(255, 255, 255));
  write(image, fmt::format("diameter less {:.2f} um, in voxels", 1e6 * expected), kLeft, 28, 0.55);
  write(image, "full colour: four standard errors of a cell", kLeft, 50);
  for (int layer = 0; layer < kLayers; ++layer)
    for (int ring = 0; ring < kRings; ++ring) {
      const Cell& cell = cells.at[static_cast<std::size_t>(layer)][static_cast<std::size_t>(ring)];
      const cv::Rect box(kLeft + ring * kCell, kTop + (kLayers - 1 - layer) * kCell / 2, kCell, kCell / 2);
      if (cell.count > 0.0) {
        const double mean = cell.sum / cell.count, error = spread / std::sqrt(cell.count);
        cv::rectangle(image, box, colour_of(error > 0.0 ? mean / (4.0 * error) : 0.0), cv::FILLED);
        write(image, fmt::format("{:+.3f}", mean / volume.spacing), box.x + 22, box.y + 24);
        write(image, fmt::format("{:.0f}", cell.count), box.x + 40, box.y + 44, 0.38);
      }
      cv::rectangle(image, box, cv::Scalar(200, 200, 200), 1);
    }
  const int base = kTop + kLayers * kCell / 2;
  write(image, "axis", kLeft - 10, base + 20);
  write(image, fmt::format("{:.0f} um", 1e6 * cells.radius), kLeft + kRings * kCell - 50, base + 20);
  write(image, "rings of equal area", kLeft + kRings * kCell / 2 - 70, base + 42);
  write(image, fmt::format("{:.0f} um", 1e6 * cells.high), 5, kTop + 12);
  write(image, fmt::format("{:.0f} um", 1e6 * cells.low), 5, base);
  return image;
}

}  // namespace pendular::segmentation
