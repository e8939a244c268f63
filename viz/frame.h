#pragma once

#include <array>
#include <vector>

#include "base/files.h"
#include "base/vec3.h"
#include "run_folder/frame.h"

namespace pendular::viz {

/// The beads and pairs of one instant of a run; SI.
struct Frame {
  using Pair = RunFrame::Line;

  double strain = 0.0, stress = 0.0;                       ///< -, Pa; NaN: not known
  double platen_bottom = 0.0, platen_top = 0.0;            ///< m
  double specimen_diameter = 0.0;                          ///< before loading, m
  std::vector<Vec3> position, displacement;                ///< m; position is the current one
  std::vector<double> diameter;                            ///< m
  std::vector<double> shear_strain, coordination, damage;  ///< damage: share of its first bonds that broke
  std::vector<std::array<int, 2>> pairs;
  std::vector<double> force;  ///< per pair, N, compression positive
  std::vector<Pair> state;    ///< per pair

  /// Centre before loading.
  Vec3 origin(std::size_t bead) const { return position[bead] - displacement[bead]; }
};

/// Reads frames/frame_*.vtp of a run folder. BadInput where it is broken, holds no beads, or lacks an array.
Frame read_frame(const fs::path& path);

/// Mean number of bonds of the beads more than one mean diameter from the mantle and the platens; NaN where
/// there are none.
double interior_coordination(const Frame& frame);

}  // namespace pendular::viz
