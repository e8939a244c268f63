#pragma once

#include "diagnosis/features.h"

namespace pendular::diagnosis {

/// The columns of an observation as another measurement of the same might have given them: values moved by
/// their stated uncertainties, or by the noise that a curve shows; the rows of a sample drawn again; counts
/// by their Poisson scatter. A function of the seed.
Columns perturbed(const Observation& observation, unsigned long seed);

}  // namespace pendular::diagnosis
