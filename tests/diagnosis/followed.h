#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/vec3.h"
#include "packing/packing.h"

namespace pendular::diagnosis::test {

/// A face-centred cubic specimen of 256 beads of some 200 µm, each a little smaller at random; ids from one.
inline std::vector<Bead> followed_specimen(std::uint64_t seed = 11) {
  constexpr double d = 200e-6, a = M_SQRT2 * d;
  std::vector<Bead> beads;
  for (int k = 0; k < 256; ++k) {
    const Vec3 cell(k / 4 % 4, k / 16 % 4, k / 64);
    const Vec3 basis[4] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
    Bead bead;
    bead.id = k + 1;
    bead.centre = a * (cell + basis[k % 4]) + 4e-6 * Vec3(random_normal(seed, 3 * static_cast<std::uint64_t>(k)),
                                                           random_normal(seed, 3 * static_cast<std::uint64_t>(k) + 1),
                                                           random_normal(seed, 3 * static_cast<std::uint64_t>(k) + 2));
    bead.diameter = d;
    beads.push_back(bead);
  }
  return beads;
}

/// A compression along z: a share of the strain across it, and a wave, so that the motion is not affine. m.
inline Vec3 compressed(const Vec3& at, double strain) {
  return {0.3 * strain * at.x(), 0.3 * strain * at.y(),
          -strain * at.z() + 0.1 * strain * 1e-3 * std::sin(at.x() / 3e-4 + at.z() / 4e-4)};
}

/// A row of a `displacements` table: a bead, and how it moved, m.
struct Followed {
  std::int64_t id;
  Vec3 at, motion;
};

inline std::vector<Followed> followed_rows(const std::vector<Bead>& beads, double strain) {
  std::vector<Followed> rows;
  for (const auto& bead : beads) rows.push_back({bead.id, bead.centre, compressed(bead.centre, strain)});
  return rows;
}

/// The table; `unit` of all lengths, m.
inline std::string followed_text(const std::vector<Followed>& rows, double strain, double unit = 1e-6,
                                 double sigma_um = 0.1) {
  std::string text = "strain,bead_id,x_um,y_um,z_um,ux_um,uy_um,uz_um,sigma_um\n";
  for (const auto& [id, at, motion] : rows)
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", strain, id, at.x() / unit, at.y() / unit, at.z() / unit,
                        motion.x() / unit, motion.y() / unit, motion.z() / unit, sigma_um);
  return text;
}

}  // namespace pendular::diagnosis::test
