#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "packing/polydata.h"

namespace pendular {

/// What every frame of a run has, frames/frame_NNNN.vtp: beads with their displacement, and lines between
/// them. Observers add arrays of their own to its table. SI.
struct RunFrame {
  enum class Line : std::int64_t { bond, broken, contact };  ///< contact: touching beads without a bond

  double strain = 0.0, stress = 0.0;             ///< platen strain; Pa
  double platen_bottom = 0.0, platen_top = 0.0;  ///< m
  double specimen_diameter = 0.0;                ///< before loading, m
  std::vector<std::int64_t> ids;
  std::vector<Vec3> position, displacement;  ///< m; position is the current one
  std::vector<double> diameter;              ///< m
  std::vector<std::array<int, 2>> pairs;     ///< of beads, by their place
  std::vector<Line> lines;                   ///< what each pair is
};

/// The table that is written, without the arrays of observers.
PolyTable table_of(const RunFrame& frame);

/// Of a table that was read from `path`. BadInput where it lacks an array, or one holds what it cannot.
RunFrame run_frame(const PolyTable& table, const fs::path& path);

/// The frames of a run folder, in order; none where it kept none.
std::vector<fs::path> frame_files(const fs::path& run);

}  // namespace pendular
