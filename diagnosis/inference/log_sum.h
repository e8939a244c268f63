#pragma once

#include <span>

namespace pendular::diagnosis {

/// log Σ exp of some terms, without overflow; −∞ where all are.
double log_sum(std::span<const double> terms);

}  // namespace pendular::diagnosis
