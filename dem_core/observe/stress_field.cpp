#include "dem_core/observe/stress_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace pendular::dem_core {
namespace {

/// A share of a pair's f ⊗ b, at one place.
struct Source {
  Vec3 place;
  Stress moment;  ///< N m
};

void add_branch(std::vector<Source>& sources, const Vec3& from, const Vec3& branch, const Vec3& force) {
  const Stress whole = force * branch.transpose();
  const Stress half = 0.25 * (whole + whole.transpose());
  for (const double s : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)})
    sources.push_back({from + s * branch, half});
}

std::vector<Source> sources_of(const Simulation& simulation, const Forces& forces) {
  const auto& beads = simulation.beads;
  std::vector<Source> sources;
  sources.reserve(2 * simulation.pairs.size());
  for (std::size_t p = 0; p < simulation.pairs.size(); ++p) {
    if (forces.pair[p].isZero(0.0)) continue;
    const Pair& pair = simulation.pairs[p];
    add_branch(sources, beads.position[pair.j], apart(simulation, pair), forces.pair[p]);
  }
  const auto add_platen = [&](const Platen& platen, const std::vector<PlatenContact>& contacts) {
    for (const auto& [k, force] : contacts) {
      const Vec3 arm(0.0, 0.0, beads.position[k].z() - platen.z);
      add_branch(sources, beads.position[k] - arm, arm, force);
    }
  };
  add_platen(simulation.bottom, forces.bottom);
  add_platen(simulation.top, forces.top);
  return sources;
}

/// Sources by cubic cells of a given size.
class Cells {
 public:
  Cells(std::vector<Source> sources, double size) : size_(size) {
    corner_ = sources.front().place;
    Vec3 far = corner_;
    for (const auto& source : sources) {
      corner_ = corner_.cwiseMin(source.place);
      far = far.cwiseMax(source.place);
    }
    // Cells grow where the sources are few in a wide space.
    const double most = 8.0 * static_cast<double>(sources.size()) + 64.0;
    while ((((far - corner_) / size_).array().floor() + 1.0).prod() > most) size_ *= 1.3;
    for (int axis = 0; axis < 3; ++axis)
      count_[axis] = static_cast<long>((far[axis] - corner_[axis]) / size_) + 1;
    std::vector<std::size_t> cell_of(sources.size()), order(sources.size());
    first_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
    for (std::size_t k = 0; k < sources.size(); ++k) {
      const auto at = cell(sources[k].place);
      cell_of[k] = index(at[0], at[1], at[2]);
      ++first_[cell_of[k] + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cell_of[a] < cell_of[b]; });
    for (std::size_t k : order) {
      places_.push_back(sources[k].place);
      moments_.push_back(sources[k].moment);
    }
  }

  /// Calls body(place, moment) for every source that may lie within two cells' size of `point`, in fixed
  /// order.
  template <typename Body>
  void around(const Vec3& point, const Body& body) const {
    const auto at = cell(point);
    const auto from = [&](int axis) { return std::max(at[axis] - 2, 0L); };
    const auto to = [&](int axis) { return std::min(at[axis] + 2, count_[axis] - 1); };
    if (from(0) > to(0)) return;
    for (long z = from(2); z <= to(2); ++z)
      for (long y = from(1); y <= to(1); ++y) {
        // Cells along x lie next to each other, so do their sources.
        const std::size_t first = first_[index(from(0), y, z)], last = first_[index(to(0), y, z) + 1];
        for (std::size_t k = first; k < last; ++k) body(places_[k], moments_[k]);
      }
  }

 private:
  /// Of a place near or in the box: far outside it counts as three cells outside.
  std::array<long, 3> cell(const Vec3& place) const {
    std::array<long, 3> at;
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = std::clamp(static_cast<long>(std::floor((place[axis] - corner_[axis]) / size_)), -3L,
                            count_[axis] + 2);
    return at;
  }
  std::size_t index(long x, long y, long z) const {
    return static_cast<std::size_t>((z * count_[1] + y) * count_[0] + x);
  }

  double size_;
  Vec3 corner_;
  std::array<long, 3> count_;
  std::vector<std::size_t> first_;  ///< source of each cell, and one past the last
  std::vector<Vec3> places_;        ///< apart from the moments, which few of them need
  std::vector<Stress> moments_;
};

}  // namespace

std::vector<Stress> stress_field(const Simulation& simulation, const Forces& forces,
                                 const std::vector<Vec3>& points, double reach) {
  std::vector<Stress> field(points.size(), Stress::Zero());
  auto sources = sources_of(simulation, forces);
  if (sources.empty()) return field;
  const Cells cells(std::move(sources), 0.5 * reach);
  const double peak = 105.0 / (16.0 * M_PI * reach * reach * reach);
  for_blocks(points.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      cells.around(points[k], [&](const Vec3& place, const Stress& moment) {
        const double squared = (points[k] - place).squaredNorm() / (reach * reach);
        if (squared >= 1.0) return;
        const double a = std::sqrt(squared), left = 1.0 - a;
        field[k] += peak * (1.0 + 3.0 * a) * left * left * left * moment;
      });
  });
  return field;
}

double stress_field_reach(const Simulation& simulation) {
  return 1.5 * simulation.beads.mean_diameter();
}

double pressure(const Stress& stress) {
  return stress.trace() / 3.0;
}

double deviatoric_stress(const Stress& stress) {
  return std::sqrt(1.5) * (stress - pressure(stress) * Stress::Identity()).norm();
}

}  // namespace pendular::dem_core
