#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/sample.h"

namespace pendular::diagnosis {

struct Kind;

/// The kind `compression` (kinds/kind.h), for the observation that nothing else is said of.
const Kind* compression_kind();

using Columns = std::map<std::string, std::vector<double>>;

/// Something that was measured (docs/diagnose.md, "The experiment file").
struct Observation {
  const Kind* kind = compression_kind();
  std::string name;
  std::vector<SampleSetting> set;  ///< where this specimen or its test differs from the sample
  fs::path file;
  fs::path beads;                            ///< the specimen's own beads; empty: not measured
  std::map<std::string, double> numbers;     ///< keys of the kind that hold numbers (Kind::keys)
  std::map<std::string, std::string> words;  ///< and those that hold words
  /// Columns by the names and in the units of the file's header; all of one length.
  Columns columns;

  bool has(const std::string& column) const { return columns.contains(column); }
  const std::vector<double>& column(const std::string& name_) const { return columns.at(name_); }
  std::size_t rows() const { return columns.begin()->second.size(); }
};

}  // namespace pendular::diagnosis
