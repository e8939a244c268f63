#include "packing/generate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "base/random.h"
#include "packing/soft_spheres.h"
#include "packing/statistics.h"

namespace pendular {
namespace {

constexpr double kMargin =
    1e-5;  // beads are packed this much larger, so that the residue of a quench is a gap
constexpr int kMaxShakes = 60;
constexpr int kQuenchSteps = 4000;
constexpr int kShakeSteps = 600;
constexpr double kShakeSpeed = 0.03;  // a few hundredths of a diameter between collisions

/// Independent streams of random numbers for one seed.
enum Stream : std::uint64_t { kDiameters, kPoints, kShakes };
std::uint64_t stream(std::uint64_t seed, Stream which) {
  return random_bits(seed, which);
}

/// Diameters in units of the mean one, their volume nearest to `volume`.
std::vector<double> diameters_filling(double volume, double relative_sd, std::uint64_t seed) {
  std::vector<double> diameters;
  for (double filled = 0.0;;) {
    const double drawn = 1.0 + relative_sd * random_normal(seed, diameters.size());
    const double diameter = std::max(drawn, 0.1);
    const double part = M_PI / 6.0 * std::pow(diameter, 3);
    if (filled + 0.5 * part > volume) return diameters;
    filled += part;
    diameters.push_back(diameter);
  }
}

std::vector<Vec3> random_points(const Cylinder& cylinder, std::size_t count, std::uint64_t seed) {
  std::vector<Vec3> points(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double r = (cylinder.radius - 0.5) * std::sqrt(random_uniform(seed, 3 * k));
    const double angle = 2.0 * M_PI * random_uniform(seed, 3 * k + 1);
    const double z = 0.5 + (cylinder.height - 1.0) * random_uniform(seed, 3 * k + 2);
    points[k] = {r * std::cos(angle), r * std::sin(angle), z};
  }
  return points;
}

/// Quenches and shakes until no overlap is deeper than the margin.
void pack(SoftSpheres& spheres, double volume_fraction, std::uint64_t seed) {
  Progress progress("packing beads", -std::log(kMargin));
  for (int shake = 0; shake <= kMaxShakes; ++shake) {
    const double overlap = spheres.quench(kQuenchSteps, kMargin);
    if (overlap < kMargin) return;
    progress.update(-std::log(overlap), fmt::format("deepest overlap {:.2g} diameters", overlap));
    spheres.shake(kShakeSteps, kShakeSpeed, random_bits(seed, static_cast<std::uint64_t>(shake)));
  }
  throw ComputationFailed(
      fmt::format("specimen.volume_fraction: {} was not reached without overlap, expected a fraction "
                  "below random close packing (about 0.62 in a cylinder 20 beads wide)",
                  volume_fraction));
}

}  // namespace

Packing generate_packing(const Sample& sample, std::uint64_t seed) {
  const double unit = sample.beads.diameter;
  const Cylinder cylinder{0.5 * sample.specimen.diameter / unit, sample.specimen.height / unit};
  if (cylinder.radius < 1.0 || cylinder.height < 2.0)
    bad_input("specimen: found a cylinder {:.3g} beads wide and {:.3g} high, expected at least 2 of each",
              2.0 * cylinder.radius, cylinder.height);
  const double volume = M_PI * cylinder.radius * cylinder.radius * cylinder.height;
  const auto diameters = diameters_filling(sample.specimen.volume_fraction * volume,
                                           sample.beads.diameter_sd / unit, stream(seed, kDiameters));
  std::vector<double> grown = diameters;
  for (double& d : grown) d *= 1.0 + 2.0 * kMargin;

  SoftSpheres spheres(cylinder, random_points(cylinder, grown.size(), stream(seed, kPoints)), grown);
  pack(spheres, sample.specimen.volume_fraction, stream(seed, kShakes));

  Packing packing;
  packing.specimen = {sample.specimen.diameter, sample.specimen.height, 0.0, 0.0, 0.0};
  packing.beads.resize(diameters.size());
  for (std::size_t k = 0; k < diameters.size(); ++k) {
    packing.beads[k].id = static_cast<std::int64_t>(k) + 1;
    packing.beads[k].centre = unit * spheres.centres()[k];
    packing.beads[k].diameter = unit * diameters[k];
  }
  flag_boundary(packing);
  return packing;
}

}  // namespace pendular
