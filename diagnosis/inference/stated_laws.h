#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/inference/comparison.h"
#include "diagnosis/inference/evidence.h"

namespace pendular::diagnosis {

/// Laws of which the experiment follows the reading that its sample states, by their ids (LawReading): under
/// each explanation that is probable, what it leaves of the gap is far more probable than with the other
/// reading, which adds its mean response and what members differ by in it. Likelihoods are normal, with
/// squares in units of what is left where that is more than the noise. `readings`: of a plan in which none is
/// settled; `known`: known_explanations() of it.
std::set<std::string> laws_as_stated(const Comparison& readings, const std::vector<Hypothesis>& known);

}  // namespace pendular::diagnosis
