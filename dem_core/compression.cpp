#include "dem_core/compression.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "dem_core/checkpoint.h"
#include "dem_core/drive/specimen_check.h"
#include "dem_core/observe/avalanches.h"
#include "dem_core/observe/quasi_static.h"
#include "dem_core/run_result.h"
#include "packing/diameters.h"
#include "packing/exchange_run.h"
#include "packing/measurement.h"
#include "packing/statistics.h"
#include "packing/touching.h"
#include "run_folder/run_folder.h"

namespace pendular::dem_core {
namespace {

std::vector<std::int64_t> bead_ids(const Packing& packing) {
  std::vector<std::int64_t> ids;
  for (const auto& bead : packing.beads) ids.push_back(bead.id);
  return ids;
}

/// What an earlier run in this folder has left must not pass for this one's.
void remove_earlier_run(const fs::path& folder) {
  for (const char* name :
       {run_file::kCurve, run_file::kEvents, run_file::kAvalanches, run_file::kResult, "run.pvd"})
    remove_output(folder / name);
  remove_checkpoints(folder);
  for (const auto& entry : fs::directory_iterator(folder / run_file::kFrames))
    if (entry.path().filename().string().starts_with("frame_")) remove_output(entry.path());
}

AvalancheWindow window_of(const Simulation& simulation, const Sample& sample) {
  const double kn = simulation.law.k_glass / sample.contact.stiffness_ratio;
  return avalanche_window(simulation, kn, platen_speed(sample) / simulation.initial_height);
}

void warn_unless_quasi_static(const std::vector<CurveRow>& rows) {
  const auto worst = quasi_static(rows);
  if (!worst || worst->holds()) return;
  warn(
      fmt::format("the run is not quasi-static where its curve is linear: found inertial number {:.2g} and "
                  "unbalanced force {:.2g}, expected at most {:.2g} and {:.2g}; try a smaller "
                  "compression.speed",
                  worst->inertial_number, worst->unbalanced_force, kQuasiStaticInertialNumber,
                  kQuasiStaticUnbalancedForce));
}

}  // namespace

Compression::Compression(const CompressTask& task)
    : task_(task), identity_(work_identity(task.packing, task.sample, task.options.work)) {
  auto kept = task.options.resume ? kept_checkpoint(task.folder, identity_) : std::nullopt;
  if (kept)
    state_ = std::move(*kept);
  else
    prepare();
  make_inner_folder(task.folder / run_file::kFrames);
  if (!kept) remove_earlier_run(task.folder);
  first_step_ = state_.simulation.steps;
}

void Compression::prepare() {
  Simulation& simulation = state_.simulation;
  simulation = build_simulation(task_.packing, task_.sample);
  check_specimen(task_.packing, simulation, task_.sample.compression.max_strain);
  simulation.bond_memory.assign(task_.options.evolution.memory * simulation.bonds.size(), 0.0);
  if (task_.options.prepare) task_.options.prepare(simulation);
}

Test Compression::test(Stepping& stepping) {
  return Test(state_, task_.sample, task_.options.evolution, task_.folder, bead_ids(task_.packing), stepping);
}

void Compression::keep() {
  const auto start = Clock::now();
  keep_checkpoint(task_.folder, state_, identity_);
  kept_at_ = Clock::now();
  checkpoint_seconds_ += seconds_since(start);
}

Performance Compression::performance(double wall_seconds, double frame_seconds) const {
  const auto steps = static_cast<double>(state_.simulation.steps - first_step_);
  return {wall_seconds, frame_seconds + checkpoint_seconds_,
          steps * static_cast<double>(state_.simulation.beads.size())};
}

CompressResult Compression::result(const Performance& performance) {
  const auto& [packing, sample, folder, options] = task_;
  warn_unless_quasi_static(state_.rows);
  if (options.read_rows) options.read_rows(state_.rows, state_.simulation);

  CompressResult result;
  result.rows = state_.rows;
  result.result = result_json(state_, sample, options.provenance);
  const auto found = avalanches(state_.simulation.events, window_of(state_.simulation, sample));
  result.result["avalanches"] = found.size();
  result.result["diameters"] = to_string(diameters_used(sample, packing.beads));
  result.result["pairs_touching_at_start"] = touching_pairs(packing.beads);
  const Coordination interior = coordination(packing.beads, packing.bridges);
  result.result["coordination"] = {{"bridges_per_interior_bead", interior.mean},
                                   {"standard_error", interior.standard_error},
                                   {"interior_beads", interior.beads}};
  result.result["performance"] = {
      {"particle_steps_per_second", performance.rate()},
      {"wall_seconds", performance.wall_seconds},
      {"output_share",
       performance.wall_seconds > 0.0 ? performance.output_seconds / performance.wall_seconds : 0.0}};
  write_curve(folder / run_file::kCurve, state_.rows, options.provenance);
  write_events(folder / run_file::kEvents, break_rows(state_.simulation, bead_ids(packing)),
               options.provenance);
  write_avalanches(folder / run_file::kAvalanches, found, options.provenance);
  if (state_.frames_written > 0) write_pvd(folder / "run.pvd", folder);
  write_text(folder / run_file::kResult, result.result.dump(2) + "\n");
  return result;
}

}  // namespace pendular::dem_core
