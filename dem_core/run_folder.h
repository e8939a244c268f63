#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/files.h"
#include "base/provenance.h"
#include "dem_core/observe/avalanches.h"
#include "dem_core/run_state.h"

namespace pendular {

/// The files of a run folder (docs/formats.md); each is written whole or not at all.

/// curve.csv: strain,stress_pa,stress_bottom_pa,broken_bonds,kinetic_energy_j,…; a cell is empty where there
/// is no such number, as of the inertial number without stress.
void write_curve(const fs::path& path, const std::vector<CurveRow>& rows, const Provenance& provenance);

/// events.csv: one row per broken bond. Mode: what of Griffith's criterion was larger; "mixed" where neither
/// makes up nine tenths of it; "compression" where the bond was shortened.
void write_events(const fs::path& path, const Simulation& simulation,
                  const std::vector<std::int64_t>& bead_ids, const Provenance& provenance);

/// avalanches.csv: one row per cluster of breaks, in order of its first.
void write_avalanches(const fs::path& path, const std::vector<Avalanche>& avalanches,
                      const Provenance& provenance);

/// result.json without the `performance` part, which alone differs between two runs of the same work.
nlohmann::ordered_json result_json(const RunState& state, const Sample& sample, const Provenance& provenance);

}  // namespace pendular
