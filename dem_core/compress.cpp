#include "dem_core/compress.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "dem_core/compression.h"
#include "dem_core/step/stepper.h"
#include "packing/bridges.h"
#include "packing/diameters.h"
#include "packing/measurement.h"

namespace pendular::dem_core {
namespace {

std::string progress_note(const RunState& state, double stress, double rate) {
  return fmt::format("strain {:.2f} %, stress {:.3f} MPa, {} broken, {:.3g} M particle-steps/s",
                     100.0 * state.simulation.strain(), 1e-6 * stress, state.simulation.events.size(),
                     1e-6 * rate);
}

CompressResult make_alone(Compression& compression) {
  const auto start = Clock::now();
  const RunState& state = compression.state();
  Stepper stepper(compression.state().simulation);
  Test test = compression.test(stepper);
  Progress progress("compress", 1.0);
  const auto so_far = [&] { return compression.performance(seconds_since(start), test.output_seconds()); };
  const auto keep = [&] { stepper.store(), compression.keep(); };
  const bool relaxing = compression.task().sample.compression.control == Control::relaxation;
  while (!state.finished) {
    if (relaxing) {
      test.relax(stepper);
    } else {
      test.before_step();
      stepper.step();
      test.after_step();
    }
    if (interrupted()) {
      keep();
      throw Interrupted(
          fmt::format("interrupted at strain {:.4f}; continue with the same command and --resume",
                      state.simulation.strain()));
    }
    if (state.open_row.steps != 0) continue;
    progress.update(test.done(), progress_note(state, test.last_stress(), so_far().rate()));
    if (!state.finished && compression.checkpoint_due()) keep();
  }
  keep();
  return compression.result(so_far());
}

}  // namespace

Packing realise(const Packing& packing, const Sample& sample, std::uint64_t seed) {
  if (diameters_used(sample, packing.beads) == Diameters::measured) return packing;
  Packing drawn = packing;
  std::vector<Vec3> centres;
  for (const auto& bead : packing.beads) centres.push_back(bead.centre);
  const auto diameters = draw_diameters(centres, sample.beads.diameter, sample.beads.realisation_sd, seed);
  bool only_candidates = true;
  for (std::size_t k = 0; k < diameters.size(); ++k) drawn.beads[k].diameter = diameters[k];
  for (const auto& bridge : packing.bridges) only_candidates &= bridge.state == BridgeState::candidate;
  if (only_candidates)
    drawn.bridges = candidate_bridges(drawn.beads, sample.bridges.cutoff * sample.beads.diameter);
  for (auto& bridge : drawn.bridges) bridge.gap = gap(drawn.beads[bridge.i], drawn.beads[bridge.j]);
  return drawn;
}

CompressResult compress(const CompressTask& task) {
  Compression compression(task);
  return make_alone(compression);
}

CompressResult compress(const Packing& packing, const Sample& sample, const fs::path& folder,
                        const CompressOptions& options) {
  return compress({packing, sample, folder, options});
}

}  // namespace pendular::dem_core
