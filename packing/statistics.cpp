#include "packing/statistics.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "packing/bridges.h"
#include "packing/touching.h"

namespace pendular {
namespace {

constexpr double kReach = 0.25;  // of curve and histogram, mean diameters
constexpr double kBin = 0.004;   // mean diameters

/// Area common to circles of radius a and b whose centres are s apart.
double lens_area(double a, double b, double s) {
  const double small = std::min(a, b);
  if (s <= std::abs(a - b)) return M_PI * small * small;
  if (s >= a + b) return 0.0;
  const double x = (s * s + a * a - b * b) / (2.0 * s);  // of the chord, from the centre of a
  const double chord = std::sqrt(std::max(0.0, a * a - x * x));
  return a * a * std::atan2(chord, x) + b * b * std::atan2(chord, s - x) - s * chord;
}

double volume_inside(const Bead& bead, const Specimen& cylinder) {
  constexpr int kSlices = 64;
  const double radius = 0.5 * bead.diameter;
  const double off_axis = std::hypot(bead.centre.x() - cylinder.axis_x, bead.centre.y() - cylinder.axis_y);
  const double low = std::max(bead.centre.z() - radius, cylinder.bottom);
  const double high = std::min(bead.centre.z() + radius, cylinder.bottom + cylinder.height);
  if (high <= low || off_axis >= radius + 0.5 * cylinder.diameter) return 0.0;
  double sum = 0.0;
  for (int k = 0; k <= kSlices; ++k) {
    const double z = low + (high - low) * k / kSlices - bead.centre.z();
    const double section = std::sqrt(std::max(0.0, radius * radius - z * z));
    const double weight = k == 0 || k == kSlices ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    sum += weight * lens_area(section, 0.5 * cylinder.diameter, off_axis);
  }
  return sum * (high - low) / (3.0 * kSlices);
}

/// Number of interior ends (0, 1 or 2) of a pair.
int interior_ends(const std::vector<Bead>& beads, const Bridge& pair) {
  return !beads[static_cast<std::size_t>(pair.i)].boundary +
         !beads[static_cast<std::size_t>(pair.j)].boundary;
}

double sd_of_diameters(const std::vector<Bead>& beads, double mean) {
  double sum = 0.0;
  for (const auto& bead : beads) sum += (bead.diameter - mean) * (bead.diameter - mean);
  return beads.size() < 2 ? 0.0 : std::sqrt(sum / static_cast<double>(beads.size() - 1));
}

std::vector<PackingStatistics::CurvePoint> coordination_curve(const Packing& packing,
                                                              const std::vector<Bridge>& pairs, double mean,
                                                              std::size_t interior) {
  std::vector<std::pair<double, int>> ends;
  for (const auto& pair : pairs) ends.emplace_back(pair.gap, interior_ends(packing.beads, pair));
  std::sort(ends.begin(), ends.end());
  std::vector<PackingStatistics::CurvePoint> curve;
  std::size_t next = 0;
  double count = 0.0;
  for (int k = 0; k * kBin <= kReach + 1e-12; ++k) {
    const double cutoff = k * kBin * mean;
    while (next < ends.size() && ends[next].first < cutoff) count += ends[next++].second;
    curve.push_back({cutoff, count / static_cast<double>(interior)});
  }
  return curve;
}

PackingStatistics::Histogram gap_histogram(const Packing& packing, const std::vector<Bridge>& pairs,
                                           double mean) {
  PackingStatistics::Histogram histogram;
  histogram.width = kBin * mean;
  double smallest = 0.0;
  for (const auto& pair : pairs) smallest = std::min(smallest, pair.gap);
  histogram.first_edge = std::floor(smallest / histogram.width) * histogram.width;
  const auto bins =
      static_cast<std::size_t>(std::ceil((kReach * mean - histogram.first_edge) / histogram.width - 1e-9));
  histogram.counts.assign(bins, 0);
  for (const auto& pair : pairs) {
    if (interior_ends(packing.beads, pair) == 0) continue;
    const auto bin = static_cast<std::size_t>((pair.gap - histogram.first_edge) / histogram.width);
    ++histogram.counts[std::min(bin, bins - 1)];
  }
  return histogram;
}

}  // namespace

Coordination coordination(const std::vector<Bead>& beads, const std::vector<Bridge>& bridges) {
  std::vector<int> counts(beads.size(), 0);
  for (const auto& bridge : bridges) {
    if (bridge.state != BridgeState::bridge && bridge.state != BridgeState::candidate) continue;
    ++counts[static_cast<std::size_t>(bridge.i)];
    ++counts[static_cast<std::size_t>(bridge.j)];
  }
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    if (beads[k].boundary) continue;
    n += 1.0;
    sum += counts[k];
    squares += static_cast<double>(counts[k]) * counts[k];
  }
  const double mean = sum / n;
  const double variance = n > 1.0 ? std::max(0.0, (squares - n * mean * mean) / (n - 1.0)) : 0.0;
  return {mean, std::sqrt(variance / n), static_cast<std::size_t>(n)};
}

double volume_fraction_within(const std::vector<Bead>& beads, const Specimen& cylinder) {
  std::vector<double> inside(beads.size());
  for_blocks(beads.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) inside[k] = volume_inside(beads[k], cylinder);
  });
  double sum = 0.0;
  for (const double v : inside) sum += v;
  return sum / cylinder.volume();
}

Specimen core_of(const Specimen& specimen, double margin) {
  Specimen core = specimen;
  core.diameter = specimen.diameter - 2.0 * margin;
  core.height = specimen.height - 2.0 * margin;
  core.bottom = specimen.bottom + margin;
  return core;
}

void flag_boundary(Packing& packing) {
  if (packing.beads.empty()) return;
  const Specimen core = core_of(packing.specimen, mean_diameter(packing.beads));
  for (auto& bead : packing.beads)
    bead.boundary =
        bead.boundary ||
        std::hypot(bead.centre.x() - core.axis_x, bead.centre.y() - core.axis_y) > 0.5 * core.diameter ||
        bead.centre.z() < core.bottom || bead.centre.z() > core.bottom + core.height;
}

Specimen specimen_around(const std::vector<Bead>& beads, double diameter, double height) {
  Vec3 lowest = Vec3::Constant(std::numeric_limits<double>::max()), highest = -lowest;
  for (const auto& bead : beads) {
    lowest = lowest.cwiseMin(bead.centre - Vec3::Constant(0.5 * bead.diameter));
    highest = highest.cwiseMax(bead.centre + Vec3::Constant(0.5 * bead.diameter));
  }
  return {diameter, height, 0.5 * (lowest.x() + highest.x()), 0.5 * (lowest.y() + highest.y()), lowest.z()};
}

Specimen specimen_enclosing(const std::vector<Bead>& beads) {
  Specimen specimen = specimen_around(beads, 0.0, 0.0);
  for (const auto& bead : beads) {
    const double off_axis = std::hypot(bead.centre.x() - specimen.axis_x, bead.centre.y() - specimen.axis_y);
    specimen.diameter = std::max(specimen.diameter, 2.0 * off_axis + bead.diameter);
    specimen.height = std::max(specimen.height, bead.centre.z() + 0.5 * bead.diameter - specimen.bottom);
  }
  return specimen;
}

PackingStatistics packing_statistics(const Packing& packing, double cutoff) {
  PackingStatistics result;
  result.beads = packing.beads.size();
  result.bridges = packing.bridges.size();
  result.mean_diameter = mean_diameter(packing.beads);
  result.diameter_sd = sd_of_diameters(packing.beads, result.mean_diameter);
  result.cutoff = cutoff;
  result.coordination = coordination(packing.beads, packing.bridges);

  double solid = 0.0;
  for (const auto& bead : packing.beads) solid += M_PI / 6.0 * std::pow(bead.diameter, 3);
  result.volume_fraction = solid / packing.specimen.volume();
  const Specimen core = core_of(packing.specimen, 1.5 * result.mean_diameter);
  result.core_volume_fraction = core.diameter > 0.0 && core.height > 0.0
                                    ? volume_fraction_within(packing.beads, core)
                                    : std::numeric_limits<double>::quiet_NaN();

  const auto pairs = candidate_bridges(packing.beads, kReach * result.mean_diameter);
  result.coordination_curve =
      coordination_curve(packing, pairs, result.mean_diameter, result.coordination.beads);
  result.gaps = gap_histogram(packing, pairs, result.mean_diameter);
  std::size_t near = 0, touching = 0;
  for (const auto& pair : pairs) {
    near += pair.gap < result.cutoff;
    touching += pair.gap < result.cutoff && touches(pair, result.mean_diameter);
  }
  result.touching_share = near == 0 ? 0.0 : static_cast<double>(touching) / static_cast<double>(near);
  return result;
}

nlohmann::ordered_json to_json(const PackingStatistics& statistics) {
  constexpr double um = 1e6;
  const auto& [mean, standard_error, interior] = statistics.coordination;
  nlohmann::ordered_json curve = nlohmann::ordered_json::array();
  for (const auto& point : statistics.coordination_curve)
    curve.push_back({{"cutoff_um", um * point.cutoff}, {"coordination", point.coordination}});
  return {{"beads", statistics.beads},
          {"interior_beads", interior},
          {"bridges", statistics.bridges},
          {"mean_diameter_um", um * statistics.mean_diameter},
          {"diameter_sd_um", um * statistics.diameter_sd},
          {"cutoff_um", um * statistics.cutoff},
          {"coordination", mean},
          {"coordination_standard_error", standard_error},
          {"volume_fraction", statistics.volume_fraction},
          {"core_volume_fraction", statistics.core_volume_fraction},
          {"touching_share", statistics.touching_share},
          {"coordination_curve", curve},
          {"gap_histogram",
           {{"first_edge_um", um * statistics.gaps.first_edge},
            {"width_um", um * statistics.gaps.width},
            {"counts", statistics.gaps.counts}}}};
}

}  // namespace pendular
