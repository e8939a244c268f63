#pragma once

#include "diagnosis/kinds/features.h"

namespace pendular::diagnosis {

/// What all stresses of a simulation may be off by together, as a share (one standard deviation): of a
/// feature that is a stress or a modulus, as it is compared; 0 of others.
double shared_stress_error(const Feature& feature);

}  // namespace pendular::diagnosis
