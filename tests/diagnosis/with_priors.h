#pragma once

#include <cmath>
#include <vector>

#include "diagnosis/inference/evidence.h"

namespace pendular::diagnosis {

/// Explanations whose priors are what their probabilities have beyond their evidences.
inline std::vector<Hypothesis> with_priors(std::vector<Hypothesis> all) {
  for (auto& h : all) h.log_prior = std::log(h.probability) - h.log_evidence;
  return all;
}

}  // namespace pendular::diagnosis
