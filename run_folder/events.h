#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/provenance.h"
#include "base/vec3.h"

namespace pendular {

/// A bond that broke: a row of events.csv. SI.
struct BreakRow {
  double strain = 0.0;
  std::int64_t bead_i = 0, bead_j = 0;  ///< ids
  Vec3 place = Vec3::Zero();            ///< m
  std::string mode;                     ///< "tension", "shear", "mixed" or "compression"
  double stretch = 0.0, shear = 0.0;    ///< m
  double energy = 0.0;                  ///< released, J
};

/// Breaks that follow from one another: a row of avalanches.csv.
struct Avalanche {
  double first_strain = 0.0, last_strain = 0.0;
  int breaks = 0;
  double energy = 0.0;         ///< released, J
  Vec3 centre = Vec3::Zero();  ///< mean place of its breaks, m
  double extent = 0.0;         ///< largest distance of a break from the centre, m
};

/// events.csv and avalanches.csv; each is written whole or not at all.
void write_events(const fs::path& path, const std::vector<BreakRow>& breaks, const Provenance& provenance);
void write_avalanches(const fs::path& path, const std::vector<Avalanche>& avalanches,
                      const Provenance& provenance);

/// The strains of all breaks, rising. BadInput where the file is damaged.
std::vector<double> read_break_strains(const fs::path& path);

}  // namespace pendular
