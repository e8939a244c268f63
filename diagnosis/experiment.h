#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/sample.h"
#include "packing/contact_peak.h"

namespace pendular::diagnosis {

enum class Kind {
  compression,
  lateral_strain,
  modulus_series,
  bridge_stiffness,
  bridge_diameters,
  bridge_gaps,
  coordination,
  displacements,
  broken_bonds
};

std::string to_string(Kind kind);

/// Something that was measured (contract, "Experiment file").
struct Observation {
  Kind kind = Kind::compression;
  std::string name;
  std::vector<SampleSetting> set;  ///< where this specimen or its test differs from the sample
  fs::path file;
  fs::path beads;  ///< the specimen's own beads; empty: not measured
  /// Columns by the names and in the units of the file's header; all of one length.
  std::map<std::string, std::vector<double>> columns;

  bool has(const std::string& column) const { return columns.contains(column); }
  const std::vector<double>& column(const std::string& name_) const { return columns.at(name_); }
  std::size_t rows() const { return columns.begin()->second.size(); }
};

/// What an experimenter measured, and what is believed about the specimens.
struct Experiment {
  std::string name;
  Sample sample;
  fs::path sample_file;
  std::map<std::string, double>
      uncertainty;  ///< one sd of a believed value, by dotted key, in the key's unit
  std::vector<Observation> observations;
  std::optional<ContactPeak> contacts;  ///< what the tables of beads show of their own errors
  std::vector<std::string> warnings;    ///< what was found odd but could be used

  /// The sample of one observation; a stated stiffness follows its polymer (believed.h).
  Sample sample_of(const Observation& observation) const;
};

/// Reads an experiment and everything it names. BadInput names file, line or column, what was found and what
/// was expected: for unknown keys and kinds, missing columns, fewer than the rows a kind needs, values that
/// are no numbers, and for what can only be a wrong unit (strain in per cent, stress not in Pa, W in per
/// cent).
Experiment read_experiment(const fs::path& path);

}  // namespace pendular::diagnosis
