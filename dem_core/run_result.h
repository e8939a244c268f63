#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/provenance.h"
#include "dem_core/run_state.h"
#include "run_folder/events.h"

namespace pendular::dem_core {

/// The bonds that broke, as a run folder states them. Mode: what of Griffith's criterion was larger; "mixed"
/// where neither makes up nine tenths of it; "compression" where the bond was shortened.
std::vector<BreakRow> break_rows(const Simulation& simulation, const std::vector<std::int64_t>& bead_ids);

/// result.json without the `performance` part, which alone differs between two runs of the same work.
nlohmann::ordered_json result_json(const RunState& state, const Sample& sample, const Provenance& provenance);

}  // namespace pendular::dem_core
