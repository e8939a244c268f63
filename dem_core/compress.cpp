#include "dem_core/compress.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "dem_core/checkpoint.h"
#include "dem_core/drive/platen_program.h"
#include "dem_core/drive/relaxation.h"
#include "dem_core/drive/specimen_check.h"
#include "dem_core/observe/avalanches.h"
#include "dem_core/observe/frame.h"
#include "dem_core/observe/lateral_strain.h"
#include "dem_core/observe/quasi_static.h"
#include "dem_core/run_result.h"
#include "dem_core/step/forces.h"
#include "dem_core/step/stepper.h"
#include "packing/bridges.h"
#include "packing/diameters.h"
#include "packing/exchange_run.h"
#include "packing/measurement.h"
#include "packing/statistics.h"
#include "packing/touching.h"
#include "run_folder/run_folder.h"

namespace pendular::dem_core {
namespace {

using Clock = std::chrono::steady_clock;

// Of the platen, between two changes of bonds that evolve: a hundredth of the strains at which bonds soften
// or relax.
constexpr double kStrainOfChanges = 1e-4;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<std::int64_t> bead_ids(const Packing& packing) {
  std::vector<std::int64_t> ids;
  for (const auto& bead : packing.beads) ids.push_back(bead.id);
  return ids;
}

/// Strains at which frames are written, rising: `frames` of them evenly from zero, the last at the end of the
/// test aside, and those of frame_at.
std::vector<double> frame_strains(const Sample::Compression& asked) {
  std::vector<double> strains = asked.frame_at;
  for (int k = 0; k < static_cast<int>(std::ceil(asked.frames)); ++k)
    strains.push_back(asked.max_strain / asked.frames * k);
  std::sort(strains.begin(), strains.end());
  return strains;
}

/// One compression test from its first to its last step.
class Test {
 public:
  Test(RunState& state, const Sample& sample, const BondEvolution& evolution, const fs::path& folder,
       std::vector<std::int64_t> ids)
      : state_(state),
        sample_(sample),
        evolution_(evolution),
        folder_(folder),
        ids_(std::move(ids)),
        frame_strains_(frame_strains(sample.compression)),
        program_(state.simulation, sample),
        stepper_(state.simulation) {
    const Simulation& s = state_.simulation;
    const double row_time = s.initial_height / (sample.compression.rows_per_strain * program_.speed());
    steps_per_row_ = std::max(1, static_cast<int>(std::lround(row_time / s.dt)));
    const double change_time = kStrainOfChanges * s.initial_height / program_.speed();
    steps_per_change_ = std::max<std::int64_t>(1, std::llround(change_time / s.dt));
  }

  /// Makes the simulation true, for a checkpoint.
  void store() { stepper_.store(); }

  /// Share of the way, for progress.
  double done() const { return program_.done(state_.simulation, last_stress()); }

  double last_stress() const { return state_.rows.empty() ? 0.0 : state_.rows.back().stress; }

  /// Wall time spent on frames, s.
  double output_seconds() const { return output_seconds_; }

  void step() {
    write_due_frames();
    if (sample_.compression.control == Control::relaxation) return relax();
    Simulation& s = state_.simulation;
    program_.drive(s, state_.platen);
    stepper_.step();
    if (evolution_.any() && s.steps % steps_per_change_ == 0)
      stepper_.change_bonds(evolution_, static_cast<double>(steps_per_change_) * s.dt);
    require_finite();
    auto& open = state_.open_row;
    open.strain += s.strain();
    open.top += s.top.force;
    open.bottom += s.bottom.force;
    if (++open.steps == steps_per_row_) close_row();
    if (program_.ended(s, state_.platen, last_stress())) finish();
  }

 private:
  /// An increment and its row. Interrupted on its way it leaves the state as it was before.
  void relax() {
    const RunState before = state_;
    Simulation& s = state_.simulation;
    const auto& asked = sample_.compression;
    const double left = asked.max_strain - s.strain();
    const bool last = left <= (1.0 + 1e-9) * asked.relax_increment;
    if (!relax_by({last ? left : asked.relax_increment, asked.relax_to})) {
      state_ = before;
      return stepper_.load();
    }
    require_finite();
    state_.open_row = {s.strain(), s.top.force, s.bottom.force, 1};
    close_row();
    if (last || program_.ended(s, state_.platen, last_stress())) finish();
  }

  /// Bonds change at the end of an increment by the time that it takes at the sample's speed, once.
  bool relax_by(const Increment& increment) {
    Simulation& s = state_.simulation;
    if (!compress_and_relax(s, stepper_, increment)) return false;
    if (!evolution_.any()) return true;
    stepper_.change_bonds(evolution_, increment.strain * s.initial_height / program_.speed());
    return come_to_rest(s, stepper_, increment.unbalanced).has_value();
  }

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
    row.halted = s.work.halted;
    row.coordination =
        2.0 * static_cast<double>(s.bonds.size() - s.events.size()) / static_cast<double>(s.beads.size());
    row.lateral_strain = lateral_strain(s);
    row.inertial_number = inertial_number(s.bottom.velocity / s.initial_height, s.beads.mean_diameter(),
                                          sample_.beads.density, row.stress);
    row.unbalanced_force = unbalanced_force(s, forces(s));
    state_.rows.push_back(row);
    open = {};
  }

  /// What is not a number anywhere in the specimen is not one in these sums either.
  void require_finite() const {
    const Simulation& s = state_.simulation;
    if (std::isfinite(s.work.damped + s.work.slipped + s.bottom.force + s.top.force)) return;
    throw ComputationFailed(
        fmt::format("compress: motion diverged at strain {:.4f}: found a force that is not a number; try a "
                    "smaller contact.time_step_fraction or contact.damping_fraction",
                    s.strain()));
  }

  /// Motion that diverges makes energy: far more than the platen brought in, or than the specimen would have
  /// if all of it moved with the platen.
  void require_sane(const Energies& now) const {
    const Simulation& s = state_.simulation;
    double mass = 0.0;
    for (double m : s.beads.mass) mass += m;
    const double brought =
        std::fabs(s.work.platen) + std::max(s.work.given, 0.0) + mass * program_.speed() * program_.speed();
    if (now.kinetic + now.elastic <= 10.0 * brought) return;
    throw ComputationFailed(
        fmt::format("compress: motion diverged at strain {:.4f}: found {:.3g} J in the specimen, "
                    "expected at most the {:.3g} J brought in; try a smaller "
                    "contact.time_step_fraction or contact.damping_fraction",
                    s.strain(), now.kinetic + now.elastic, brought));
  }

  void write_due_frames() {
    const auto written = static_cast<std::size_t>(state_.frames_written);
    if (written < frame_strains_.size() && state_.simulation.strain() >= frame_strains_[written])
      write_next_frame();
  }

  void write_next_frame() {
    const auto start = Clock::now();
    stepper_.store();
    write_frame(folder_ / run_file::kFrames / fmt::format("frame_{:04d}.vtp", state_.frames_written),
                state_.simulation, ids_, last_stress(), sample_.observe);
    ++state_.frames_written;
    output_seconds_ += seconds_since(start);
  }

  void finish() {
    if (state_.open_row.steps > 0) close_row();
    if (sample_.compression.frames > 0.0) write_next_frame();
    state_.finished = true;
  }

  RunState& state_;
  const Sample& sample_;
  const BondEvolution& evolution_;
  fs::path folder_;
  std::vector<std::int64_t> ids_;
  std::vector<double> frame_strains_;
  PlatenProgram program_;
  Stepper stepper_;
  int steps_per_row_ = 1;
  std::int64_t steps_per_change_ = 1;
  double output_seconds_ = 0.0;
};

/// What this run of the program did.
struct Performance {
  double wall_seconds = 0.0;
  double output_seconds = 0.0;  ///< of these, on frames and checkpoints
  double particle_steps = 0.0;
  double rate() const { return wall_seconds > 0.0 ? particle_steps / wall_seconds : 0.0; }
};

std::string progress_note(const RunState& state, double stress, double rate) {
  return fmt::format("strain {:.2f} %, stress {:.3f} MPa, {} broken, {:.3g} M particle-steps/s",
                     100.0 * state.simulation.strain(), 1e-6 * stress, state.simulation.events.size(),
                     1e-6 * rate);
}

Performance run(RunState& state, const Sample& sample, const CompressOptions& options, const fs::path& folder,
                std::vector<std::int64_t> ids, const std::string& identity) {
  const auto start = Clock::now();
  const std::int64_t first_step = state.simulation.steps;
  Test test(state, sample, options.evolution, folder, std::move(ids));
  Progress progress("compress", 1.0);
  double checkpoint_seconds = 0.0;
  const auto so_far = [&] {
    const double steps = static_cast<double>(state.simulation.steps - first_step);
    return Performance{seconds_since(start), test.output_seconds() + checkpoint_seconds,
                       steps * static_cast<double>(state.simulation.beads.size())};
  };
  auto last_checkpoint = start;
  const auto keep = [&] {
    last_checkpoint = Clock::now();
    test.store();
    keep_checkpoint(folder, state, identity);
    checkpoint_seconds += seconds_since(last_checkpoint);
  };
  while (!state.finished) {
    test.step();
    if (interrupted()) {
      keep();
      throw Interrupted(
          fmt::format("interrupted at strain {:.4f}; continue with the same command and --resume",
                      state.simulation.strain()));
    }
    if (state.open_row.steps != 0) continue;
    progress.update(test.done(), progress_note(state, test.last_stress(), so_far().rate()));
    if (!state.finished && seconds_since(last_checkpoint) >= options.checkpoint_every) keep();
  }
  keep();
  return so_far();
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

CompressResult compress(const Packing& packing, const Sample& sample, const fs::path& folder,
                        const CompressOptions& options) {
  const std::string identity = work_identity(packing, sample, options.work);
  auto kept = options.resume ? kept_checkpoint(folder, identity) : std::nullopt;
  RunState state;
  if (kept) {
    state = std::move(*kept);
  } else {
    state.simulation = build_simulation(packing, sample);
    check_specimen(packing, state.simulation, sample.compression.max_strain);
    state.simulation.bond_memory.assign(options.evolution.memory * state.simulation.bonds.size(), 0.0);
    if (options.prepare) options.prepare(state.simulation);
  }
  make_inner_folder(folder / run_file::kFrames);
  if (!kept) remove_earlier_run(folder);
  const auto ids = bead_ids(packing);
  const Performance performance = run(state, sample, options, folder, ids, identity);
  warn_unless_quasi_static(state.rows);
  if (options.read_rows) options.read_rows(state.rows, state.simulation);

  CompressResult result;
  result.rows = state.rows;
  result.result = result_json(state, sample, options.provenance);
  const auto found = avalanches(state.simulation.events, window_of(state.simulation, sample));
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
  write_curve(folder / run_file::kCurve, state.rows, options.provenance);
  write_events(folder / run_file::kEvents, break_rows(state.simulation, ids), options.provenance);
  write_avalanches(folder / run_file::kAvalanches, found, options.provenance);
  if (state.frames_written > 0) write_pvd(folder / "run.pvd", folder);
  write_text(folder / run_file::kResult, result.result.dump(2) + "\n");
  return result;
}

}  // namespace pendular::dem_core
