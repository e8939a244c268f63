#include "blind/engine_truth.h"

#include <map>

#include "blind/engine_run.h"
#include "dem_core/bond_bodies.h"
#include "effects/compress.h"
#include "effects/list.h"

namespace pendular::blind {
namespace {

/// The specimen as it is, by those effects alone that are of its measurement.
effects::ActualSpecimen without_physics(const EngineTest& test) {
  Sample sample = test.sample;
  std::erase_if(sample.effects,
                [](const auto& item) { return effects::find_effect(item.first, "engine").truth == nullptr; });
  return effects::actual_specimen(test.reported, sample, test.seed);
}

/// The bridges that the engine found standing at rest, and their bodies in the packing's order.
void take_bridges(TrueTest& truth, const EngineResult& result) {
  std::map<std::pair<int, int>, std::size_t> made;
  for (std::size_t k = 0; k < result.bonds.size(); ++k) made[result.bonds[k]] = k;
  for (auto& bridge : truth.packing.bridges)
    if (!made.contains({bridge.i, bridge.j})) bridge.state = BridgeState::none;
  for (const auto& bridge : dem_core::standing_bridges(truth.packing)) {
    const std::size_t k = made.at({bridge.i, bridge.j});
    truth.bodies.push_back({result.neck[k], result.gap[k], truth.packing.beads[bridge.i].diameter,
                            truth.packing.beads[bridge.j].diameter});
  }
}

}  // namespace

TrueTest engine_truth(const EngineTest& test, const fs::path& scratch) {
  const auto specimen = without_physics(test);
  Sample sample = specimen.sample;
  sample.effects = test.sample.effects;
  EngineRun run{test.engine, specimen.packing, sample, test.seed, test.max_strain, {}, {}};
  if (test.unload_at > 0.0) run.unload_at = {test.unload_at};
  if (test.scan_at > 0.0) run.frame_at = {test.scan_at};
  const EngineResult result = run_engine(run, scratch);
  fs::remove_all(scratch);

  TrueTest truth;
  truth.sample = test.sample;
  truth.packing = specimen.packing;
  truth.rows = result.rows;
  truth.engine = result.engine;
  take_bridges(truth, result);
  if (!result.frames.empty())
    truth.scan = {result.frames[0].displacement,
                  {result.frames[0].bonds.begin(), result.frames[0].bonds.end()}};
  return truth;
}

}  // namespace pendular::blind
