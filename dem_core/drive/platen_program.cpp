#include "dem_core/drive/platen_program.h"

#include <algorithm>
#include <cmath>

namespace pendular::dem_core {
namespace {

double beads_near_bottom(const Simulation& simulation) {
  const auto& beads = simulation.beads;
  const double lowest = simulation.top.z - simulation.initial_height;  // the top platen rests
  double near = 0.0;
  for (std::size_t k = 0; k < beads.size(); ++k)
    near += beads.start[k].z() - beads.radius[k] <= lowest + 2.0 * beads.radius[k];
  return std::max(near, 1.0);
}

}  // namespace

PlatenProgram::PlatenProgram(const Simulation& simulation, const Sample& sample)
    : asked_(sample.compression), speed_(platen_speed(sample)) {
  const LawParameters& law = simulation.law;
  gain_ = 0.5 / (beads_near_bottom(simulation) * (law.k_glass * simulation.dt + law.damping));
  const double hold_time =
      asked_.hold_time ? *asked_.hold_time : asked_.hold * simulation.initial_height / speed_;
  hold_steps_ = std::max<std::int64_t>(1, std::llround(hold_time / simulation.dt));
}

void PlatenProgram::drive(Simulation& simulation, PlatenProgress& progress) const {
  if (asked_.control == Control::stress) return follow_ramp(simulation);
  if (hold(simulation, progress)) {
    simulation.bottom.velocity = 0.0;
    return;
  }
  turn(simulation, progress);
  simulation.bottom.velocity = progress.unloading ? -speed_ : speed_;
}

void PlatenProgram::follow_ramp(Simulation& simulation) const {
  const double time = static_cast<double>(simulation.steps) * simulation.dt;
  const double ramp = *asked_.stress_rate * time * simulation.section;
  simulation.bottom.velocity = std::clamp(gain_ * (ramp - simulation.bottom.force), -speed_, speed_);
}

/// Whether the platen rests.
bool PlatenProgram::hold(const Simulation& simulation, PlatenProgress& progress) const {
  if (progress.holding) {
    if (simulation.steps < progress.hold_until) return true;
    progress.holding = false;
    ++progress.holds_done;
  }
  if (progress.unloading || progress.holds_done >= static_cast<int>(asked_.hold_at.size()) ||
      simulation.strain() < asked_.hold_at[progress.holds_done])
    return false;
  progress.holding = true;
  progress.hold_until = simulation.steps + hold_steps_;
  return true;
}

/// Unloading: the platen goes back until the specimen carries hardly any load.
void PlatenProgram::turn(const Simulation& simulation, PlatenProgress& progress) const {
  if (progress.unloading) {
    if (simulation.top.force > 0.01 * progress.force_at_reversal) return;
    progress.unloading = false;
    ++progress.unloadings_done;
  } else if (progress.unloadings_done < static_cast<int>(asked_.unload_at.size()) &&
             simulation.strain() >= asked_.unload_at[progress.unloadings_done]) {
    progress.unloading = true;
    progress.force_at_reversal = simulation.top.force;
  }
}

bool PlatenProgram::ended(const Simulation& simulation, const PlatenProgress& progress, double stress) const {
  if (progress.holding) return false;
  const bool holds_to_come = progress.holds_done < static_cast<int>(asked_.hold_at.size()) &&
                             simulation.strain() >= asked_.hold_at[progress.holds_done];
  if (simulation.strain() >= asked_.max_strain) return !holds_to_come;
  return asked_.max_stress && stress >= *asked_.max_stress;
}

double PlatenProgram::done(const Simulation& simulation, double stress) const {
  const double strained = simulation.strain() / asked_.max_strain;
  return asked_.max_stress ? std::max(strained, stress / *asked_.max_stress) : strained;
}

}  // namespace pendular::dem_core
