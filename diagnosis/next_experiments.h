#pragma once

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis {

/// Further measurements that the experiment does not have, best value for its cost first: of each, the
/// expected probability that one explanation has four fifths afterwards. A measurement tells whether one of
/// the effects that it bears on is there, and takes the others' part no further; so the expectation is over
/// the present probabilities. Empty where one explanation has four fifths already.
std::vector<NextExperiment> next_experiments(const Experiment& experiment,
                                             const std::vector<Explanation>& explanations);

}  // namespace pendular::diagnosis
