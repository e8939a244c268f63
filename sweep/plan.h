#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "sweep/request.h"

namespace pendular::sweep {

/// Keys varied together: as many points as each key has values.
struct Axis {
  std::vector<std::string> keys;                 ///< dotted keys of the sample, or "W"
  std::vector<std::vector<SampleValue>> points;  ///< per point one value for each key
};

/// What a sweep file asks for.
struct SweepFile {
  std::string name = "sweep";  ///< shown with progress
  fs::path sample;
  fs::path packing;        ///< empty: generated
  std::uint64_t seed = 1;  ///< of the first realisation; the others follow
  int realisations = 1;
  bool packing_each = false;       ///< each realisation has a generated packing of its own
  std::uint64_t packing_seed = 1;  ///< of the packing that all share
  bool keep_all = false;
  std::vector<Axis> axes;  ///< all combinations of their points
};

/// Reads a sweep file (docs/sweep.md); paths in it are relative to it. BadInput names file, line and key.
/// A seed that is given here counts instead of the file's.
SweepFile read_sweep(const fs::path& path, const std::optional<std::uint64_t>& seed = std::nullopt);

/// A value as a table shows it.
std::string to_string(const SampleValue& value);

/// A family of runs, in the order in which tables show them.
struct Plan {
  struct Run {
    std::size_t point = 0;            ///< counted from 1
    std::vector<SampleValue> values;  ///< of the varied keys
    int realisation = 1;
    std::uint64_t seed = 1;
  };
  std::vector<std::string> keys;  ///< varied
  std::vector<Run> runs;
  std::vector<RunRequest> requests;  ///< one per run
};

/// The runs of a sweep file: for each point, in the order of the axes with the last one fastest, its
/// realisations. BadInput where the values of a point do not make a sample.
Plan plan_of(const SweepFile& file);

}  // namespace pendular::sweep
