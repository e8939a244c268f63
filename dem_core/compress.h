#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/files.h"
#include "base/provenance.h"
#include "base/sample.h"
#include "dem_core/drive/bond_evolution.h"
#include "dem_core/observe/curve.h"
#include "packing/packing.h"

namespace pendular::dem_core {

/// The packing that a realisation compresses. Where diameters are drawn (diameters_used()), every bead's is,
/// as the paper does, and candidate bridges are those below the cut-off for the drawn diameters; measured
/// bridges stay. Else the packing is used as it is.
Packing realise(const Packing& packing, const Sample& sample, std::uint64_t seed);

struct CompressOptions {
  bool resume = false;             ///< go on from the folder's checkpoint, if there is one
  double checkpoint_every = 30.0;  ///< wall time between checkpoints, s
  Provenance provenance;

  /// Where a run departs from the paper's model; without them it does not. `work`: what they follow from
  /// beside the sample; a checkpoint is gone on from where it is the same.
  std::string work;
  std::function<void(Simulation&)> prepare;  ///< changes the specimen before its test
  BondEvolution evolution;                   ///< of its bonds; empty: they stay as they are
  /// What the instruments make of the true rows; the result and its curve are of what this leaves.
  std::function<void(std::vector<CurveRow>&, const Simulation&)> read_rows;
};

struct CompressResult {
  std::vector<CurveRow> rows;
  nlohmann::ordered_json result;  ///< what result.json holds
};

/// One compression test.
struct CompressTask {
  Packing packing;
  Sample sample;
  fs::path folder;
  CompressOptions options;
};

/// Uniaxial compression between two platens to the sample's max_strain, into a run folder: curve.csv,
/// events.csv, frames/, result.json, checkpoint. The packing is compressed as given; see realise().
/// Interrupted by the user it keeps a checkpoint and throws Interrupted; where motion diverges it keeps the
/// last good checkpoint and throws ComputationFailed.
CompressResult compress(const CompressTask& task);
CompressResult compress(const Packing& packing, const Sample& sample, const fs::path& folder,
                        const CompressOptions& options);

/// What has become of a task: a result, or what compress() would have thrown.
struct CompressOutcome {
  std::optional<CompressResult> result;
  std::exception_ptr error;
};
using CompressEnded = std::function<void(std::size_t task, const CompressOutcome& outcome)>;

/// So many tasks at most can be made side by side.
inline constexpr std::size_t kMostSideBySide = 8;

/// The first task, and of the others those that can be made beside it in the lanes of a register
/// (SideBySide), on one thread: the same bytes as from compress(), in two thirds of the time where eight are
/// made. Tells of each as it ends; of tasks that it does not make, nothing. Interrupted by the user it keeps
/// a checkpoint of each and throws Interrupted.
void compress_side_by_side(std::span<const CompressTask> tasks, const CompressEnded& ended);

}  // namespace pendular::dem_core
