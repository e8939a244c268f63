#pragma once

#include <cstdint>

#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// How far the moving platen is in its program.
struct PlatenProgress {
  int unloadings_done = 0, holds_done = 0;
  bool unloading = false, holding = false;
  double force_at_reversal = 0.0;  ///< on the fixed platen, N
  std::int64_t hold_until = 0;     ///< step
};

/// Drives the moving platen as the sample's [compression] asks.
///
/// control = "speed": at constant speed; at the strains of unload_at back until the fixed platen carries 1 %
/// of what it did; at those of hold_at at rest for the hold time.
///
/// control = "stress": a servo follows a ramp of stress on the moving platen, v = g (F_ramp − F), no faster
/// than the speed. The platen is then a dashpot of coefficient 1/g pushed by the ramp's force: it takes
/// energy out whatever g is, and lags the ramp by v/g. g = ½/(n (k_glass dt + ζ)), half of the largest for
/// which explicit steps are stable, with n the beads within a diameter of the platen at the start.
class PlatenProgram {
 public:
  PlatenProgram(const Simulation& simulation, const Sample& sample);

  /// Sets the platen's velocity for the next step.
  void drive(Simulation& simulation, PlatenProgress& progress) const;

  /// The largest strain or, where the sample asks for it, the largest stress (Pa) is reached.
  bool ended(const Simulation& simulation, const PlatenProgress& progress, double stress) const;

  /// Share of the way, for progress.
  double done(const Simulation& simulation, double stress) const;

  double speed() const { return speed_; }  ///< m/s

 private:
  void follow_ramp(Simulation& simulation) const;
  bool hold(const Simulation& simulation, PlatenProgress& progress) const;
  void turn(const Simulation& simulation, PlatenProgress& progress) const;

  Sample::Compression asked_;
  double speed_;
  double gain_;              ///< of the servo, m/s per N
  std::int64_t hold_steps_;  ///< length of a hold
};

}  // namespace pendular::dem_core
