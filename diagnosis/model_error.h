#pragma once

#include "diagnosis/features.h"

namespace pendular::diagnosis {

/// Standard deviation of a feature that two sound simulations of one model may differ by, as it is compared:
/// laws that the model leaves open (damping, what counts as quasi-static, one tangential spring or two) and
/// the reading of curves. Without it a difference of numerics is taken for physics. docs/diagnose.md says
/// where the values come from.
double model_error(const Feature& feature);

/// The part of it that all stresses of a simulation share.
double shared_stress_error(const Feature& feature);

}  // namespace pendular::diagnosis
