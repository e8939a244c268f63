#include "dem_core/compress.h"

#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "dem_core/checkpoint.h"
#include "dem_core/run_folder.h"
#include "dem_core/stepper.h"
#include "packing/bridges.h"
#include "packing/diameters.h"
#include "packing/statistics.h"

namespace pendular {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<std::int64_t> bead_ids(const Packing& packing) {
  std::vector<std::int64_t> ids;
  for (const auto& bead : packing.beads) ids.push_back(bead.id);
  return ids;
}

/// One compression test from its first to its last step.
class Test {
 public:
  Test(RunState& state, const Sample& sample, const fs::path& folder, std::vector<std::int64_t> ids)
      : state_(state), sample_(sample), folder_(folder), ids_(std::move(ids)), stepper_(state.simulation) {
    const Simulation& s = state_.simulation;
    const double row_time = s.initial_height / (sample.compression.rows_per_strain * platen_speed(sample));
    steps_per_row_ = std::max(1, static_cast<int>(std::lround(row_time / s.dt)));
  }

  /// Makes the simulation true, for a checkpoint.
  void store() { stepper_.store(); }

  /// Strain, as a share of the way, for progress.
  double done() const { return state_.simulation.strain(); }

  void step() {
    write_due_frames();
    stepper_.step();
    auto& open = state_.open_row;
    open.strain += state_.simulation.strain();
    open.top += state_.simulation.top.force;
    open.bottom += state_.simulation.bottom.force;
    if (++open.steps == steps_per_row_) close_row();
    turn_platen();
    if (state_.simulation.strain() >= sample_.compression.max_strain) finish();
  }

 private:
  void close_row() {
    stepper_.store();
    const Simulation& s = state_.simulation;
    auto& open = state_.open_row;
    const Energies now = energies(s);
    require_sane(now);
    CurveRow row;
    row.strain = open.strain / open.steps;
    row.stress = open.top / open.steps / s.section;
    row.stress_bottom = open.bottom / open.steps / s.section;
    row.broken_bonds = static_cast<double>(s.events.size());
    row.kinetic = now.kinetic;
    row.elastic = now.elastic;
    row.work = s.work.platen;
    row.damped = s.work.damped;
    row.slipped = s.work.slipped;
    row.released = s.work.broken;
    row.coordination =
        2.0 * static_cast<double>(s.bonds.size() - s.events.size()) / static_cast<double>(s.beads.size());
    state_.rows.push_back(row);
    open = {};
  }

  /// Motion that diverges makes energy: far more than the platen brought in, or than the specimen would have
  /// if all of it moved with the platen.
  void require_sane(const Energies& now) const {
    const Simulation& s = state_.simulation;
    double mass = 0.0;
    for (double m : s.beads.mass) mass += m;
    const double brought = std::fabs(s.work.platen) + mass * s.bottom.velocity * s.bottom.velocity;
    if (now.kinetic + now.elastic <= 10.0 * brought) return;
    throw ComputationFailed(
        fmt::format("compress: motion diverged at strain {:.4f}: found {:.3g} J in the specimen, "
                    "expected at most the {:.3g} J brought in; try a smaller "
                    "contact.time_step_fraction or contact.damping_fraction",
                    s.strain(), now.kinetic + now.elastic, brought));
  }

  /// Unloading: the platen goes back at the strains asked for until the specimen carries hardly any load.
  void turn_platen() {
    Simulation& s = state_.simulation;
    const auto& turns = sample_.compression.unload_at;
    const double speed = std::fabs(s.bottom.velocity);
    if (state_.unloading) {
      if (s.top.force > 0.01 * state_.force_at_reversal) return;
      state_.unloading = false;
      ++state_.unloadings_done;
      s.bottom.velocity = speed;
    } else if (state_.unloadings_done < static_cast<int>(turns.size()) &&
               s.strain() >= turns[state_.unloadings_done]) {
      state_.unloading = true;
      state_.force_at_reversal = s.top.force;
      s.bottom.velocity = -speed;
    }
  }

  void write_due_frames() {
    const double interval = sample_.compression.max_strain / sample_.compression.frames;
    if (state_.simulation.strain() >= interval * state_.frames_written) write_next_frame();
  }

  void write_next_frame() {
    stepper_.store();
    const double stress = state_.rows.empty() ? 0.0 : state_.rows.back().stress;
    write_frame(folder_ / "frames" / fmt::format("frame_{:04d}.vtp", state_.frames_written),
                state_.simulation, ids_, stress);
    ++state_.frames_written;
  }

  void finish() {
    if (state_.open_row.steps > 0) close_row();
    write_next_frame();
    state_.finished = true;
  }

  RunState& state_;
  const Sample& sample_;
  fs::path folder_;
  std::vector<std::int64_t> ids_;
  Stepper stepper_;
  int steps_per_row_ = 1;
};

std::string progress_note(const RunState& state) {
  return fmt::format("strain {:.2f} %, stress {:.3f} MPa, {} broken", 100.0 * state.simulation.strain(),
                     state.rows.empty() ? 0.0 : 1e-6 * state.rows.back().stress,
                     state.simulation.events.size());
}

void run(RunState& state, const Sample& sample, const fs::path& folder, std::vector<std::int64_t> ids,
         const std::string& identity, double checkpoint_every) {
  Test test(state, sample, folder, std::move(ids));
  Progress progress("compress", sample.compression.max_strain);
  auto last_checkpoint = Clock::now();
  while (!state.finished) {
    test.step();
    if (interrupted()) {
      test.store();
      write_checkpoint(folder / "checkpoint", state, identity);
      throw Interrupted(fmt::format(
          "interrupted at strain {:.4f}; continue with the same command and --resume", test.done()));
    }
    if (state.open_row.steps != 0) continue;
    progress.update(test.done(), progress_note(state));
    if (seconds_since(last_checkpoint) < checkpoint_every) continue;
    test.store();
    write_checkpoint(folder / "checkpoint", state, identity);
    last_checkpoint = Clock::now();
  }
  test.store();
  write_checkpoint(folder / "checkpoint", state, identity);
}

/// What an earlier run in this folder has left must not pass for this one's.
void remove_earlier_run(const fs::path& folder) {
  for (const char* name : {"curve.csv", "events.csv", "result.json", "checkpoint"}) fs::remove(folder / name);
  for (const auto& entry : fs::directory_iterator(folder / "frames"))
    if (entry.path().filename().string().starts_with("frame_")) fs::remove(entry.path());
}

std::string identity_of(const Provenance& provenance) {
  return sha256(to_json(provenance).dump());
}

}  // namespace

Packing realise(const Packing& packing, const Sample& sample, std::uint64_t seed) {
  if (sample.beads.diameters == "measured") return packing;
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

CompressResult compress(const Packing& packing, const Sample& sample, const fs::path& folder,
                        const CompressOptions& options) {
  const std::string identity = identity_of(options.provenance);
  const fs::path checkpoint = folder / "checkpoint";
  RunState state;
  const bool resumed = options.resume && fs::exists(checkpoint);
  if (resumed)
    state = read_checkpoint(checkpoint, identity);
  else
    state.simulation = build_simulation(packing, sample);
  make_folder(folder / "frames");
  if (!resumed) remove_earlier_run(folder);
  const auto ids = bead_ids(packing);
  const std::int64_t first_step = state.simulation.steps;
  const auto start = Clock::now();
  run(state, sample, folder, ids, identity, options.checkpoint_every);
  const double wall = seconds_since(start);

  CompressResult result;
  result.rows = state.rows;
  result.result = result_json(state, sample.beads.diameter, options.provenance);
  const double particle_steps = static_cast<double>(state.simulation.steps - first_step) *
                                static_cast<double>(state.simulation.beads.size());
  const Coordination interior = coordination(packing.beads, packing.bridges);
  result.result["coordination"] = {{"bridges_per_interior_bead", interior.mean},
                                   {"standard_error", interior.standard_error},
                                   {"interior_beads", interior.beads}};
  result.result["performance"] = {{"particle_steps_per_second", wall > 0.0 ? particle_steps / wall : 0.0},
                                  {"wall_seconds", wall}};
  write_curve(folder / "curve.csv", state.rows, options.provenance);
  write_events(folder / "events.csv", state.simulation, ids, options.provenance);
  write_text(folder / "result.json", result.result.dump(2) + "\n");
  return result;
}

}  // namespace pendular
