#pragma once

#include <vector>

#include "diagnosis/experiment/experiment.h"

namespace pendular::diagnosis {

/// A specimen and its test as a simulation must repeat them.
struct Condition {
  Sample sample;   ///< as believed, with the observations' settings and the test's course
  fs::path beads;  ///< the specimen's own; empty: not measured
  std::vector<std::size_t> observations;  ///< those that it answers, by their place in the experiment
  std::size_t row = 0;                    ///< of a modulus series: its row
  fs::path network =
      {};  ///< the specimen's measured bridges, where they are simulated as they are; else empty
};

/// Whether a condition's test ends at a scan: displacements are simulated apart from the whole curve, so that
/// many of these short tests can be made.
bool ends_at_scan(const Condition& condition);

/// What must be simulated to answer an experiment, each specimen and test once: observations that differ in
/// nothing but how far they go share a condition that goes as far as the farthest, unloads where any of them
/// does, and leaves room for a toe of another length. A modulus series is a condition for each row that
/// supports the others. Measured single bridges need none. Tests slower than quasi-static are simulated at
/// 1e-4 in model units, with the polymer's relaxation time shortened likewise.
std::vector<Condition> conditions_of(const Experiment& experiment);

}  // namespace pendular::diagnosis
