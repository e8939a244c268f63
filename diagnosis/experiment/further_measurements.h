#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/experiment/experiment.h"

namespace pendular::diagnosis {

/// A measurement that could be added to an experiment.
struct FurtherMeasurement {
  std::string name, why;
  double cost = 1.0;  ///< in units of one compression test
  /// The experiment with it, planned: its columns say where it reads and with which errors, not what it
  /// shows. Nothing where the experiment has it, or lacks what it needs. Null: it is not of a specimen.
  std::function<std::optional<Experiment>(const Experiment&)> added = nullptr;
  std::set<std::string> settles =
      {};  ///< of one that is not of a specimen: effects that it finds or rules out
};

/// Every measurement that is considered. Tests go as far as the farthest of the experiment.
std::vector<FurtherMeasurement> further_measurements();

/// One compression test, planned, of a specimen whose beads were scanned at rest; they are made up from the
/// sample and written into `folder`. `beliefs`: an experiment without observations.
Experiment planned_experiment(const Experiment& beliefs, const fs::path& folder);

/// A planned observation with the columns that a simulation of it shows.
void show(Observation& planned, const Columns& simulated);

}  // namespace pendular::diagnosis
