#pragma once

#include <vector>

namespace pendular::diagnosis {

/// log Σ exp of some terms, without overflow; −∞ where all are.
double log_sum(const std::vector<double>& terms);

}  // namespace pendular::diagnosis
