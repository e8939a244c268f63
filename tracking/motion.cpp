#include "tracking/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/number_cell.h"
#include "base/quantile.h"
#include "packing/bridges.h"
#include "tracking/following.h"

namespace pendular::tracking {
namespace {

constexpr double kLoose = 0.2;         // departure, mean diameters
constexpr double kLooseTypical = 5.0;  // departure over that of the beads around
constexpr double kAround = 1.5;        // gap of these, mean diameters
constexpr double kStill = 1.5;         // rms displacement over its stated error
constexpr double kSame = 1e-9;         // m

/// How far each bead of the first scan lies from where its neighbours lead it, m; −1: not known.
std::vector<double> departures(const Following& following, const std::vector<Bead>& after,
                               const Partners& partners, const std::vector<bool>& without) {
  std::vector<double> all(partners.size(), -1.0);
  for (std::size_t k = 0; k < partners.size(); ++k) {
    if (partners[k] < 0) continue;
    if (const auto expected = following.led_to(partners, k, without))
      all[k] = (after[static_cast<std::size_t>(partners[k])].centre - *expected).norm();
  }
  return all;
}

/// Of each bead of the first scan.
std::vector<bool> loose_beads(const std::vector<Bead>& before, const std::vector<Bead>& after,
                              const std::vector<BeadMatch>& matches) {
  const Following following(before, after);
  const auto around = neighbours_within(before, kAround * following.diameter());
  Partners partners(before.size(), -1);
  for (const auto& match : matches) partners[static_cast<std::size_t>(match.before)] = match.after;
  std::vector<bool> loose(before.size(), false);
  // In the second round those of the first lead no others astray.
  for (int round = 0; round < 2; ++round) {
    const auto departure = departures(following, after, partners, loose);
    std::vector<bool> found(before.size(), false);
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (departure[k] < kLoose * following.diameter()) continue;
      std::vector<double> typical;
      for (const int other : around[k])
        if (departure[static_cast<std::size_t>(other)] >= 0.0)
          typical.push_back(departure[static_cast<std::size_t>(other)]);
      found[k] = departure[k] > kLooseTypical * median(std::move(typical));
    }
    loose = std::move(found);
  }
  return loose;
}

void find_unmatched(Motion& motion, std::size_t before, std::size_t after) {
  std::vector<bool> found(before, false), claimed(after, false);
  for (const auto& match : motion.matches)
    found[static_cast<std::size_t>(match.before)] = claimed[static_cast<std::size_t>(match.after)] = true;
  for (std::size_t k = 0; k < before; ++k)
    if (!found[k]) motion.lost.push_back(static_cast<int>(k));
  for (std::size_t k = 0; k < after; ++k)
    if (!claimed[k]) motion.fresh.push_back(static_cast<int>(k));
}

/// Displacements, their errors and local strains; `after` in the frame of the first scan.
void measure(Motion& motion, const std::vector<Bead>& before, const std::vector<Bead>& after) {
  std::vector<Vec3> now;
  std::vector<double> radii, shear;
  double square = 0.0, variance = 0.0;
  bool stated = true;
  for (const auto& match : motion.matches) {
    const Bead &a = before[static_cast<std::size_t>(match.before)],
               &b = after[static_cast<std::size_t>(match.after)];
    const bool both = a.sigma_centre > 0.0 && b.sigma_centre > 0.0;
    motion.start.push_back(a.centre);
    motion.displacement.push_back(b.centre - a.centre);
    motion.sigma.push_back(both ? std::hypot(a.sigma_centre, b.sigma_centre) : 0.0);
    now.push_back(b.centre);
    radii.push_back(0.5 * a.diameter);
    square += motion.displacement.back().squaredNorm();
    variance += 3.0 * motion.sigma.back() * motion.sigma.back();
    stated = stated && both;
  }
  const double count = static_cast<double>(motion.matches.size());
  motion.still = std::sqrt(square / count) < (stated ? kStill * std::sqrt(variance / count) : kSame);
  motion.local = kinematics::local_strains(motion.start, now, radii);
  for (const auto& local : motion.local) shear.push_back(local.shear);
  if (!motion.still) motion.band = kinematics::find_shear_band(motion.start, shear, mean_diameter(before));
}

}  // namespace

Motion follow_beads(const std::vector<Bead>& before, const std::vector<Bead>& after,
                    const TrackOptions& options) {
  Motion motion;
  const Registration rough = register_scans(before, after, options.strain);
  const auto near = registered(after, rough.motion);
  motion.matches = match_beads(before, near, rough.even, options.match);
  const auto loose = loose_beads(before, near, motion.matches);
  std::vector<BeadMatch> followed;
  for (const auto& match : motion.matches) {
    motion.loose.push_back(loose[static_cast<std::size_t>(match.before)]);
    if (!motion.loose.back()) followed.push_back(match);
  }
  motion.registration = registration_of(before, after, followed, options.strain);
  motion.strain = options.strain.value_or(1.0 - motion.registration.axial_stretch);
  measure(motion, before, registered(after, motion.registration.motion));
  find_unmatched(motion, before.size(), after.size());
  return motion;
}

void write_motion(const fs::path& path, const std::vector<Bead>& before, const std::vector<Bead>& after,
                  const Motion& motion, const Provenance& provenance) {
  const bool stated =
      std::all_of(motion.sigma.begin(), motion.sigma.end(), [](double sigma) { return sigma > 0.0; });
  std::string text = to_comment(provenance);
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "strain,bead_id,x_um,y_um,z_um,ux_um,uy_um,uz_um,{}bead_id_after,score,shear_strain,"
                 "volumetric_strain,state\n",
                 stated ? "sigma_um," : "");
  for (std::size_t k = 0; k < motion.matches.size(); ++k) {
    const BeadMatch& match = motion.matches[k];
    const Vec3 at = 1e6 * motion.start[k], moved = 1e6 * motion.displacement[k];
    fmt::format_to(out, "{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}", NumberCell{motion.strain},
                   before[static_cast<std::size_t>(match.before)].id, NumberCell{at.x()}, NumberCell{at.y()},
                   NumberCell{at.z()}, NumberCell{moved.x()}, NumberCell{moved.y()}, NumberCell{moved.z()});
    if (stated) fmt::format_to(out, ",{:.4f}", NumberCell{1e6 * motion.sigma[k]});
    fmt::format_to(out, ",{},{:.3f},{:.6g},{:.6g},{}\n", after[static_cast<std::size_t>(match.after)].id,
                   NumberCell{match.score}, NumberCell{motion.local[k].shear},
                   NumberCell{motion.local[k].volumetric}, motion.loose[k] ? "loose" : "followed");
  }
  write_text(path, text);
}

}  // namespace pendular::tracking
