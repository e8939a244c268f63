#include "dem_core/test.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "dem_core/observe/frame.h"
#include "dem_core/observe/lateral_strain.h"
#include "dem_core/observe/quasi_static.h"
#include "dem_core/step/forces.h"
#include "run_folder/run_folder.h"

namespace pendular::dem_core {
namespace {

// Of the platen, between two changes of bonds that evolve: a hundredth of the strains at which bonds soften
// or relax.
constexpr double kStrainOfChanges = 1e-4;

/// Strains at which frames are written, rising: `frames` of them evenly from zero, the last at the end of the
/// test aside, and those of frame_at.
std::vector<double> frame_strains(const Sample::Compression& asked) {
  std::vector<double> strains = asked.frame_at;
  for (int k = 0; k < static_cast<int>(std::ceil(asked.frames)); ++k)
    strains.push_back(asked.max_strain / asked.frames * k);
  std::sort(strains.begin(), strains.end());
  return strains;
}

}  // namespace

Test::Test(RunState& state, const Sample& sample, const BondEvolution& evolution, const fs::path& folder,
           std::vector<std::int64_t> ids, Stepping& stepping)
    : state_(state),
      sample_(sample),
      evolution_(evolution),
      folder_(folder),
      ids_(std::move(ids)),
      frame_strains_(frame_strains(sample.compression)),
      program_(state.simulation, sample),
      stepping_(stepping) {
  const Simulation& s = state_.simulation;
  const double row_time = s.initial_height / (sample.compression.rows_per_strain * program_.speed());
  steps_per_row_ = std::max(1, static_cast<int>(std::lround(row_time / s.dt)));
  const double change_time = kStrainOfChanges * s.initial_height / program_.speed();
  steps_per_change_ = std::max<std::int64_t>(1, std::llround(change_time / s.dt));
}

void Test::before_step() {
  write_due_frames();
  program_.drive(state_.simulation, state_.platen);
}

void Test::after_step() {
  Simulation& s = state_.simulation;
  if (evolution_.any() && s.steps % steps_per_change_ == 0)
    stepping_.change_bonds(evolution_, static_cast<double>(steps_per_change_) * s.dt);
  auto& open = state_.open_row;
  open.strain += s.strain();
  open.top += s.top.force;
  open.bottom += s.bottom.force;
  if (++open.steps == steps_per_row_) close_row();
  if (program_.ended(s, state_.platen, last_stress())) finish();
}

void Test::relax(Stepper& stepper) {
  write_due_frames();
  const RunState before = state_;
  Simulation& s = state_.simulation;
  const auto& asked = sample_.compression;
  const double left = asked.max_strain - s.strain();
  const bool last = left <= (1.0 + 1e-9) * asked.relax_increment;
  if (!relax_by(stepper, {last ? left : asked.relax_increment, asked.relax_to})) {
    state_ = before;
    return stepper.load();
  }
  state_.open_row = {s.strain(), s.top.force, s.bottom.force, 1};
  close_row();
  if (last || program_.ended(s, state_.platen, last_stress())) finish();
}

/// Bonds change at the end of an increment by the time that it takes at the sample's speed, once.
bool Test::relax_by(Stepper& stepper, const Increment& increment) {
  Simulation& s = state_.simulation;
  if (!compress_and_relax(s, stepper, increment)) return false;
  if (!evolution_.any()) return true;
  stepping_.change_bonds(evolution_, increment.strain * s.initial_height / program_.speed());
  return come_to_rest(s, stepper, increment.unbalanced).has_value();
}

void Test::close_row() {
  stepping_.store();
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

/// Motion that diverges makes energy: far more than the platen brought in, or than the specimen would have
/// if all of it moved with the platen.
void Test::require_sane(const Energies& now) const {
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

void Test::write_due_frames() {
  const auto written = static_cast<std::size_t>(state_.frames_written);
  if (written < frame_strains_.size() && state_.simulation.strain() >= frame_strains_[written])
    write_next_frame();
}

void Test::write_next_frame() {
  const auto start = std::chrono::steady_clock::now();
  stepping_.store();
  write_frame(folder_ / run_file::kFrames / fmt::format("frame_{:04d}.vtp", state_.frames_written),
              state_.simulation, ids_, last_stress(), sample_.observe);
  ++state_.frames_written;
  output_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Test::finish() {
  if (state_.open_row.steps > 0) close_row();
  if (sample_.compression.frames > 0.0) write_next_frame();
  state_.finished = true;
}

}  // namespace pendular::dem_core
