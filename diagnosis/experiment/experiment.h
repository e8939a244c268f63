#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/sample.h"
#include "diagnosis/experiment/observation.h"
#include "packing/contact_peak.h"

namespace pendular::diagnosis {

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

/// What is believed of specimens of which nothing was measured: an experiment file without observations, or
/// the sample itself. Nothing where the file states observations. BadInput as read_experiment().
std::optional<Experiment> read_beliefs(const fs::path& path);

}  // namespace pendular::diagnosis
