#include "segmentation/search/container.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/quantile.h"
#include "segmentation/search/grey_levels.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

struct MeanAndSpread {
  double mean = 0.0, spread = 0.0;
};

MeanAndSpread summary(double n, double sum, double squares) {
  if (n < 1.0) return {};
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

/// Between the 2 % and 98 % quantiles: from air to bead, however much of the picture the container takes. Of
/// some millions of nodes.
double range_of(const Grid<float>& grey) {
  constexpr std::size_t enough = std::size_t{1} << 22;
  const std::size_t step = grey.values.size() / enough + 1;
  std::vector<float> values;
  for (std::size_t n = 0; n < grey.values.size(); n += step) values.push_back(grey.values[n]);
  return static_cast<double>(lower_quantile(values, 0.98)) -
         static_cast<double>(lower_quantile(values, 0.02));
}

/// For each column of nodes, along z: the spread over all slices, where pistons make the columns of beads
/// vary all the more, and the mean over the middle six tenths, where there are beads only.
std::vector<MeanAndSpread> columns_of(const Grid<float>& grey) {
  const std::size_t first = grey.size[2] / 5, last = grey.size[2] - first;
  std::vector<MeanAndSpread> columns(grey.size[0] * grey.size[1]);
  for_blocks(grey.size[1], 8, [&](std::size_t j0, std::size_t j1) {
    for (std::size_t j = j0; j < j1; ++j) {
      std::vector<double> sum(grey.size[0], 0.0), squares(grey.size[0], 0.0), middle(grey.size[0], 0.0);
      for (std::size_t k = 0; k < grey.size[2]; ++k)
        for (std::size_t i = 0; i < grey.size[0]; ++i) {
          const double g = grey.values[grey.index(i, j, k)];
          sum[i] += g;
          squares[i] += g * g;
          if (k >= first && k < last) middle[i] += g;
        }
      for (std::size_t i = 0; i < grey.size[0]; ++i)
        columns[j * grey.size[0] + i] = {
            middle[i] / static_cast<double>(last - first),
            summary(static_cast<double>(grey.size[2]), sum[i], squares[i]).spread};
    }
  });
  return columns;
}

/// What parts columns of beads from others.
double busy_from(const std::vector<MeanAndSpread>& columns, double edge) {
  std::vector<float> spreads;
  for (const MeanAndSpread& column : columns) spreads.push_back(static_cast<float>(column.spread));
  return std::clamp(grey_levels(histogram_of(spreads)).threshold, kThresholds.least_busy_spread * edge,
                    kThresholds.most_busy_spread * edge);
}

/// A disc in nodes.
struct Disc {
  double x = 0.0, y = 0.0, radius = 0.0;
};

/// The columns that vary, if they fill a disc that is clear of the picture's sides.
std::optional<Disc> busy_disc(const Grid<float>& grey, const std::vector<MeanAndSpread>& columns,
                              double least_spread) {
  const std::size_t nx = grey.size[0], ny = grey.size[1];
  const auto busy = [&](std::size_t i, std::size_t j) { return columns[j * nx + i].spread > least_spread; };
  double area = 0.0, x = 0.0, y = 0.0;
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i)
      if (busy(i, j)) {
        area += 1.0;
        x += static_cast<double>(i);
        y += static_cast<double>(j);
      }
  if (area < 50.0) return std::nullopt;
  const Disc disc{x / area, y / area, std::sqrt(area / M_PI)};
  double inside = 0.0, inside_busy = 0.0;
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i) {
      const double r = std::hypot(static_cast<double>(i) - disc.x, static_cast<double>(j) - disc.y);
      if (r > 0.9 * disc.radius) continue;
      inside += 1.0;
      inside_busy += busy(i, j);
    }
  const bool round = inside_busy > 0.9 * inside && inside_busy > 0.7 * area;
  const bool clear = disc.x - disc.radius > 1.0 && disc.x + disc.radius < static_cast<double>(nx) - 2.0 &&
                     disc.y - disc.radius > 1.0 && disc.y + disc.radius < static_cast<double>(ny) - 2.0;
  if (!round || !clear) return std::nullopt;
  return disc;
}

/// Linear between the four columns around (x, y); NaN outside the picture.
double mean_at(const Grid<float>& grey, const std::vector<MeanAndSpread>& columns, double x, double y) {
  const double i = std::floor(x), j = std::floor(y);
  if (i < 0.0 || j < 0.0 || i + 1.0 >= static_cast<double>(grey.size[0]) ||
      j + 1.0 >= static_cast<double>(grey.size[1]))
    return std::nan("");
  const auto column = [&](double a, double b) {
    return columns[static_cast<std::size_t>(b) * grey.size[0] + static_cast<std::size_t>(a)].mean;
  };
  const double u = x - i, v = y - j;
  return (1 - v) * ((1 - u) * column(i, j) + u * column(i + 1, j)) +
         v * ((1 - u) * column(i, j + 1) + u * column(i + 1, j + 1));
}

/// Where a profile sampled at `step` from `start` steps up most, refined by a parabola; none if the step up
/// from the least value before to the greatest just after is below `least`.
std::optional<double> steepest_rise(const std::vector<double>& profile, double start, double step,
                                    double least) {
  std::size_t best = 0;
  double steepest = 0.0;
  const auto slope = [&](std::size_t k) { return profile[k + 1] - profile[k - 1]; };
  for (std::size_t k = 2; k + 2 < profile.size(); ++k)
    if (slope(k) > steepest) {
      steepest = slope(k);
      best = k;
    }
  if (best == 0) return std::nullopt;
  const auto reach = static_cast<std::size_t>(std::lround(3.0 / step));
  const auto from = profile.begin() + (best > reach ? best - reach : 0);
  const auto to = profile.begin() + std::min(profile.size(), best + reach + 1);
  const double low = *std::min_element(from, profile.begin() + best);
  const double high = *std::max_element(profile.begin() + best, to);
  if (!(high - low > least)) return std::nullopt;
  const double before = slope(best - 1), after = slope(best + 1);
  const double curvature = before - 2.0 * steepest + after;
  const double shift = curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
  return start + step * (static_cast<double>(best) + shift);
}

/// The circle through points in the least-squares sense (Kåsa 1976, IEEE Trans. Instrum. Meas.), with points
/// further than three typical distances from it left out once.
Disc circle_through(std::vector<Eigen::Vector2d> points) {
  Disc circle;
  for (int round = 0; round < 2; ++round) {
    Eigen::MatrixXd A(points.size(), 3);
    Eigen::VectorXd b(points.size());
    for (std::size_t n = 0; n < points.size(); ++n) {
      A.row(static_cast<Eigen::Index>(n)) << 2.0 * points[n].x(), 2.0 * points[n].y(), 1.0;
      b[static_cast<Eigen::Index>(n)] = points[n].squaredNorm();
    }
    const Eigen::Vector3d s = A.colPivHouseholderQr().solve(b);
    circle = {s[0], s[1], std::sqrt(s[2] + s[0] * s[0] + s[1] * s[1])};
    const auto off = [&](const Eigen::Vector2d& p) {
      return std::abs((p - Eigen::Vector2d(circle.x, circle.y)).norm() - circle.radius);
    };
    std::vector<double> distances;
    for (const auto& p : points) distances.push_back(off(p));
    const double limit = std::max(0.3, 4.5 * median(std::move(distances)));
    std::erase_if(points, [&](const auto& p) { return off(p) > limit; });
    if (points.size() < 12) break;
  }
  return circle;
}

/// The inner face of the tube: seen in sectors as a rise of the mean from the loose layer along it.
std::optional<Disc> tube_of(const Grid<float>& grey, const std::vector<MeanAndSpread>& columns,
                            const Disc& busy, double edge) {
  constexpr int sectors = 90;
  constexpr double step = 0.25;  // nodes
  std::vector<Eigen::Vector2d> points;
  for (int sector = 0; sector < sectors; ++sector) {
    const double angle = 2.0 * M_PI * sector / sectors, c = std::cos(angle), s = std::sin(angle);
    const double from = busy.radius - std::max(4.0, 0.06 * busy.radius),
                 to = busy.radius + std::max(6.0, 0.08 * busy.radius);
    std::vector<double> profile;
    for (int k = 0; from + k * step < to; ++k) {
      const double r = from + k * step;
      const double mean = mean_at(grey, columns, busy.x + r * c, busy.y + r * s);
      if (std::isnan(mean)) break;
      profile.push_back(mean);
    }
    if (const auto r = steepest_rise(profile, from, step, kThresholds.tube_step * edge))
      points.emplace_back(busy.x + *r * c, busy.y + *r * s);
  }
  if (points.size() < 2 * sectors / 3) return std::nullopt;
  const Disc tube = circle_through(points);
  if (!(std::abs(tube.radius - busy.radius) < 0.1 * busy.radius)) return std::nullopt;
  return tube;
}

/// Within nine tenths of the tube's radius, for each slice.
std::vector<MeanAndSpread> slices_of(const Grid<float>& grey, const Disc& tube) {
  std::vector<MeanAndSpread> slices(grey.size[2]);
  for_blocks(grey.size[2], 1, [&](std::size_t k, std::size_t) {
    double n = 0.0, sum = 0.0, squares = 0.0;
    for (std::size_t j = 0; j < grey.size[1]; ++j)
      for (std::size_t i = 0; i < grey.size[0]; ++i) {
        const double x = static_cast<double>(i) - tube.x, y = static_cast<double>(j) - tube.y;
        if (x * x + y * y > 0.81 * tube.radius * tube.radius) continue;
        const double g = grey.values[grey.index(i, j, k)];
        n += 1.0;
        sum += g;
        squares += g * g;
      }
    slices[k] = summary(n, sum, squares);
  });
  return slices;
}

/// The face of a piston that follows slices[first], first+step, …, in nodes along that way; none if the mean
/// does not step up where the beads end.
std::optional<double> piston_face(const std::vector<MeanAndSpread>& slices, bool upwards, double least_spread,
                                  double edge) {
  const auto n = std::ssize(slices);
  const auto slice = [&](std::ptrdiff_t k) -> const MeanAndSpread& {
    return slices[upwards ? k : n - 1 - k];
  };
  std::ptrdiff_t last_busy = -1;
  for (std::ptrdiff_t k = 0; k < n; ++k)
    if (slice(k).spread > least_spread) last_busy = k;
  if (last_busy < 0) return std::nullopt;
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, last_busy - 4),
                       to = std::min<std::ptrdiff_t>(n, last_busy + 8);
  std::vector<double> profile;
  for (std::ptrdiff_t k = from; k < to; ++k) profile.push_back(slice(k).mean);
  const auto face = steepest_rise(profile, static_cast<double>(from), 1.0, kThresholds.piston_step * edge);
  if (!face) return std::nullopt;
  return upwards ? *face : static_cast<double>(n - 1) - *face;
}

}  // namespace

std::optional<Container> find_container(const Grid<float>& grey) {
  const double edge = range_of(grey);
  const auto columns = columns_of(grey);
  const double least_spread = busy_from(columns, edge);
  const auto busy = busy_disc(grey, columns, least_spread);
  if (!busy) return std::nullopt;
  const auto tube = tube_of(grey, columns, *busy, edge);
  if (!tube) return std::nullopt;
  const double f = grey.factor;
  const auto full = [&](double node) { return (node + 0.5) * f - 0.5; };
  Container container{full(tube->x), full(tube->y), tube->radius * f, std::nullopt, std::nullopt};
  const auto slices = slices_of(grey, *tube);
  if (const auto face = piston_face(slices, false, least_spread, edge)) container.bottom = full(*face);
  if (const auto face = piston_face(slices, true, least_spread, edge)) container.top = full(*face);
  return container;
}

bool within(const Container& container, const Vec3& p) {
  const double x = p.x() - container.axis_x, y = p.y() - container.axis_y;
  return x * x + y * y < container.radius * container.radius &&
         (!container.bottom || p.z() > *container.bottom) && (!container.top || p.z() < *container.top);
}

void clear_outside(Grid<std::uint8_t>& mask, const Container& container) {
  for_blocks(mask.size[2], 1, [&](std::size_t k, std::size_t) {
    for (std::size_t j = 0; j < mask.size[1]; ++j)
      for (std::size_t i = 0; i < mask.size[0]; ++i)
        if (!within(container, mask.at(i, j, k))) mask.values[mask.index(i, j, k)] = 0;
  });
}

}  // namespace pendular::segmentation
