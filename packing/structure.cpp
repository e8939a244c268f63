#include "packing/structure.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "packing/bridges.h"
#include "packing/neighbours.h"
#include "packing/statistics.h"

namespace pendular {
namespace {

constexpr double kShell = 0.02, kFarthest = 3.0;  // mean diameters
constexpr double kLeastReferences = 20.0;
constexpr std::size_t kSlabs = 10, kBins = 10;

bool inside(const Vec3& p, const Specimen& s) {
  return s.diameter > 0.0 && s.height > 0.0 &&
         std::hypot(p.x() - s.axis_x, p.y() - s.axis_y) < 0.5 * s.diameter && p.z() > s.bottom &&
         p.z() < s.bottom + s.height;
}

/// Of beads about those `margin` inside: the farthest whole shell that leaves enough of them.
void add_radial_distribution(const Packing& packing, double diameter, Structure& structure) {
  double farthest = kFarthest, references = 0.0, within = 0.0;
  std::vector<bool> reference(packing.beads.size());
  while (farthest >= 1.5) {
    const Specimen core = core_of(packing.specimen, farthest * diameter);
    references = 0.0;
    for (std::size_t k = 0; k < reference.size(); ++k)
      references += reference[k] = inside(packing.beads[k].centre, core);
    if (references >= kLeastReferences) break;
    farthest -= 0.5;
  }
  if (references < kLeastReferences) return;
  // Centres are no nearer to walls than a radius: their density is that of the layer inside.
  const Specimen dense = core_of(packing.specimen, diameter);
  for (const auto& bead : packing.beads) within += inside(bead.centre, dense);
  const double density = within / dense.volume();
  std::vector<double> counts(static_cast<std::size_t>(std::lround(farthest / kShell)), 0.0);
  const std::vector<double> points(packing.beads.size(), 0.0);
  for (const auto& [i, j] : pairs_within(centres_of(packing.beads), points, farthest * diameter)) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const double r = (packing.beads[a].centre - packing.beads[b].centre).norm() / diameter;
    const auto shell = static_cast<std::size_t>(r / kShell);
    if (shell < counts.size())
      counts[shell] += static_cast<double>(reference[a]) + static_cast<double>(reference[b]);
  }
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double low = kShell * static_cast<double>(k) * diameter, high = low + kShell * diameter;
    const double expected = references * density * 4.0 / 3.0 * M_PI * (high * high * high - low * low * low);
    structure.r_over_d.push_back((static_cast<double>(k) + 0.5) * kShell);
    structure.g.push_back(counts[k] / expected);
  }
}

/// In mean diameters, refined by the centre of gravity of the highest shell and its neighbours.
double first_peak_of(const Structure& structure) {
  constexpr double near = 0.2, high = 1.5;
  std::size_t best = 0;
  for (std::size_t k = 1; k + 1 < structure.g.size(); ++k)
    if (std::fabs(structure.r_over_d[k] - 1.0) < near && structure.g[k] > std::max(high, structure.g[best]))
      best = k;
  if (best == 0) return 0.0;
  double weight = 0.0, sum = 0.0;
  for (std::size_t k = best - 1; k <= best + 1; ++k)
    weight += structure.g[k], sum += structure.g[k] * structure.r_over_d[k];
  return sum / weight;
}

void add_slabs(const Packing& packing, Structure& structure) {
  Specimen slab = packing.specimen;
  slab.height /= static_cast<double>(kSlabs);
  if (!(slab.volume() > 0.0)) return;
  for (std::size_t k = 0; k < kSlabs; ++k) {
    slab.bottom = packing.specimen.bottom + static_cast<double>(k) * slab.height;
    structure.slab_middle.push_back(slab.bottom + 0.5 * slab.height);
    structure.slab_fraction.push_back(volume_fraction_within(packing.beads, slab));
  }
}

void add_orientation(const Packing& packing, const std::vector<Bridge>& bridges, Structure& structure) {
  structure.orientation.assign(kBins, 0);
  double sum = 0.0, squares = 0.0;
  for (const auto& bridge : bridges) {
    const Bead &a = packing.beads[static_cast<std::size_t>(bridge.i)],
               &b = packing.beads[static_cast<std::size_t>(bridge.j)];
    if (a.boundary && b.boundary) continue;
    const double cosine = std::fabs((b.centre - a.centre).normalized().z());
    ++structure.orientation[std::min(kBins - 1, static_cast<std::size_t>(cosine * kBins))];
    structure.bridges += 1.0, sum += cosine * cosine, squares += std::pow(cosine, 4);
  }
  if (structure.bridges < 2.0) return;
  structure.cos2 = sum / structure.bridges;
  structure.cos2_error =
      std::sqrt(std::max(0.0, squares / structure.bridges - structure.cos2 * structure.cos2) /
                (structure.bridges - 1.0));
}

/// Of a cylinder between two spheres, less both.
double neck_volume(double radius, double gap, double a, double b) {
  // ∫ 2πϱ (δ + h_a + h_b) dϱ with h = R − √(R² − ϱ²)
  const auto cap = [radius](double R) {
    return M_PI * R * radius * radius -
           2.0 / 3.0 * M_PI * (R * R * R - std::pow(R * R - radius * radius, 1.5));
  };
  return std::max(0.0, M_PI * radius * radius * gap + cap(a) + cap(b));
}

void add_necks(const Packing& packing, const std::vector<Bridge>& bridges, Structure& structure) {
  struct Foot {
    Vec3 direction;
    double angle;  // that the neck covers on the bead, from its axis
    std::size_t bridge;
  };
  std::vector<std::vector<Foot>> feet(packing.beads.size());
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < bridges.size(); ++k) {
    const Bridge& bridge = bridges[k];
    const Bead &a = packing.beads[static_cast<std::size_t>(bridge.i)],
               &b = packing.beads[static_cast<std::size_t>(bridge.j)];
    if (!(bridge.diameter > 0.0) || bridge.diameter >= std::min(a.diameter, b.diameter)) continue;
    count += 1.0, sum += bridge.diameter, squares += bridge.diameter * bridge.diameter;
    structure.polymer_volume +=
        neck_volume(0.5 * bridge.diameter, bridge.gap, 0.5 * a.diameter, 0.5 * b.diameter);
    const Vec3 n = (b.centre - a.centre).normalized();
    feet[static_cast<std::size_t>(bridge.i)].push_back({n, std::asin(bridge.diameter / a.diameter), k});
    feet[static_cast<std::size_t>(bridge.j)].push_back({-n, std::asin(bridge.diameter / b.diameter), k});
  }
  if (count == 0.0) return;
  structure.neck_diameter = sum / count;
  structure.neck_sd =
      count > 1.0 ? std::sqrt(std::max(0.0, (squares - sum * sum / count) / (count - 1.0))) : 0.0;
  std::vector<bool> meets(bridges.size(), false);
  for (const auto& own : feet)
    for (std::size_t p = 0; p < own.size(); ++p)
      for (std::size_t q = p + 1; q < own.size(); ++q)
        if (std::acos(std::clamp(own[p].direction.dot(own[q].direction), -1.0, 1.0)) <
            own[p].angle + own[q].angle)
          meets[own[p].bridge] = meets[own[q].bridge] = true;
  structure.meeting = static_cast<std::size_t>(std::count(meets.begin(), meets.end(), true));
}

}  // namespace

Structure structure_of(const Packing& packing) {
  Structure structure;
  if (packing.beads.empty()) return structure;
  std::vector<Bridge> bridges;
  for (const auto& bridge : packing.bridges)
    if (bridge.state == BridgeState::bridge || bridge.state == BridgeState::candidate)
      bridges.push_back(bridge);
  add_radial_distribution(packing, mean_diameter(packing.beads), structure);
  structure.first_peak = first_peak_of(structure) * mean_diameter(packing.beads);
  add_slabs(packing, structure);
  add_orientation(packing, bridges, structure);
  add_necks(packing, bridges, structure);
  return structure;
}

nlohmann::ordered_json to_json(const Structure& structure) {
  std::vector<double> middles;
  for (const double middle : structure.slab_middle) middles.push_back(1e6 * middle);
  nlohmann::ordered_json necks = nullptr;
  if (structure.neck_diameter > 0.0)
    necks = {{"bridge_diameter_um", 1e6 * structure.neck_diameter},
             {"bridge_diameter_sd_um", 1e6 * structure.neck_sd},
             {"polymer_volume_mm3", 1e9 * structure.polymer_volume},
             {"meeting_bridges", structure.meeting}};
  return {
      {"radial_distribution",
       {{"r_over_d", structure.r_over_d}, {"g", structure.g}, {"first_peak_um", 1e6 * structure.first_peak}}},
      {"volume_fraction_by_height", {{"z_um", middles}, {"volume_fraction", structure.slab_fraction}}},
      {"orientation",
       {{"mean_cos2_to_axis", structure.cos2},
        {"standard_error", structure.cos2_error},
        {"by_cos_to_axis", structure.orientation}}},
      {"necks", necks}};
}

}  // namespace pendular
