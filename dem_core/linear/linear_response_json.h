#pragma once

#include <nlohmann/json_fwd.hpp>

#include "dem_core/linear/linear_response.h"

namespace pendular::dem_core {

/// What modulus.json holds, but for its provenance; `strain` is what the contacts were found for.
nlohmann::ordered_json to_json(const LinearResponse& response, const Simulation& simulation, double strain);

}  // namespace pendular::dem_core
