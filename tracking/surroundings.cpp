#include "tracking/surroundings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "packing/bridges.h"
#include "packing/neighbours.h"

namespace pendular::tracking {
namespace {

constexpr double kSigmas = 5.0, kOwnDiameter = 2e-3;
constexpr double kCellsPerBead = 16.0;

}  // namespace

BeadGrid::BeadGrid(const std::vector<Bead>& beads, double edge) : edge_(edge) {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (std::size_t k = 0; k < beads.size(); ++k) {
    low = k == 0 ? beads[k].centre : Vec3(low.cwiseMin(beads[k].centre));
    high = k == 0 ? beads[k].centre : Vec3(high.cwiseMax(beads[k].centre));
  }
  origin_ = low;
  const auto count = [&] { return ((high - low) / edge_).array().floor().matrix() + Vec3::Ones(); };
  while (Vec3(count()).prod() > kCellsPerBead * static_cast<double>(beads.size() + 1)) edge_ *= 1.5;
  const Vec3 counted = count();
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = static_cast<long>(counted[axis]);

  const auto index = [&](const Bead& bead) {
    return static_cast<std::size_t>((cell(bead.centre.x(), 0) * cells_[1] + cell(bead.centre.y(), 1)) *
                                        cells_[2] +
                                    cell(bead.centre.z(), 2));
  };
  first_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  for (const auto& bead : beads) ++first_[index(bead) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  beads_.resize(beads.size()), centres_.resize(beads.size());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < beads.size(); ++k) {
    const std::size_t at = next[index(beads[k])]++;
    beads_[at] = static_cast<int>(k), centres_[at] = beads[k].centre;
  }
}

long BeadGrid::cell(double coordinate, int axis) const {
  // Places far outside stay in the range of a whole number.
  return static_cast<long>(std::floor(std::clamp((coordinate - origin_[axis]) / edge_, -1e9, 1e9)));
}

std::vector<std::vector<int>> neighbours_within(const std::vector<Bead>& beads, double gap) {
  std::vector<std::vector<int>> found(beads.size());
  for (const auto& [i, j] : pairs_within(centres_of(beads), diameters_of(beads), gap)) {
    found[static_cast<std::size_t>(i)].push_back(j);
    found[static_cast<std::size_t>(j)].push_back(i);
  }
  for (auto& all : found) std::sort(all.begin(), all.end());
  return found;
}

bool alike(const Bead& a, const Bead& b, double mean_diameter) {
  const double sigma = std::hypot(a.sigma_diameter, b.sigma_diameter);
  return sigma == 0.0 || std::fabs(a.diameter - b.diameter) < kSigmas * sigma + kOwnDiameter * mean_diameter;
}

}  // namespace pendular::tracking
