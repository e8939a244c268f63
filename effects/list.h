#pragma once

#include <string>
#include <vector>

#include "effects/effect.h"

namespace pendular::effects {

/// Every effect, in the order in which they are applied.
const std::vector<Effect>& all_effects();

/// By its id; BadInput, opening with `where`, names the nearest one where there is none.
const Effect& find_effect(const std::string& id, const std::string& where);

/// Names and ranges of a sample's effects. BadInput, opening with `where`.
void check_effects(const Sample& sample, const std::string& where);

}  // namespace pendular::effects
