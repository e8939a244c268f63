#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/vec3.h"
#include "blind/engine.h"
#include "dem_core/observe/curve.h"
#include "packing/packing.h"

namespace pendular::blind {

/// A test that another program is to make.
struct EngineRun {
  const Engine& engine;
  const Packing& packing;   ///< beads that are; its candidate bridges are for the engine to thin out
  const Sample& sample;     ///< true of them, with the effects that the engine is to have
  std::uint64_t seed = 1;   ///< of the engine's draws
  double max_strain = 0.0;  ///< as read, likewise the others
  std::vector<double> unload_at, frame_at;
};

/// What it asks of the engine, as the text of run.json. BadInput where the engine cannot have it.
std::string run_text(const EngineRun& run);

/// A specimen under load.
struct EngineFrame {
  double strain = 0.0;                               ///< of the platen
  std::vector<Vec3> displacement;                    ///< of the beads since rest, m
  std::vector<std::pair<int, int>> bonds, touching;  ///< pairs of beads that a bond joins, or glass
};

/// What an engine made of a test.
struct EngineResult {
  std::string engine;                      ///< its name and version
  std::vector<std::pair<int, int>> bonds;  ///< at rest
  std::vector<double> gap, neck;           ///< of their bodies, m
  std::vector<CurveRow> rows;              ///< strain, stress, breaks and lateral strain, as read
  std::vector<EngineFrame> frames;
  std::vector<double> breaks;  ///< platen strains at which bonds broke
};

/// Reads result.json of a test of so many beads, with one frame for each that was asked for.
/// ComputationFailed, in one line that names the file, where it is missing, or something in it is, or is not
/// a number, or is of another specimen.
EngineResult read_result(const fs::path& path, std::size_t beads, std::size_t frames);

/// Has the engine make the test in `folder`, which is made. ComputationFailed where it is not installed,
/// ends with an error, or leaves no result that can be used.
EngineResult run_engine(const EngineRun& run, const fs::path& folder);

/// ComputationFailed, in one line, where the engine's program cannot be found.
void require_installed(const Engine& engine);

}  // namespace pendular::blind
