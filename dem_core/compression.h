#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "dem_core/compress.h"
#include "dem_core/run_state.h"
#include "dem_core/test.h"

namespace pendular::dem_core {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What this run of the program did.
struct Performance {
  double wall_seconds = 0.0;
  double output_seconds = 0.0;  ///< of these, on frames and checkpoints
  double particle_steps = 0.0;
  double rate() const { return wall_seconds > 0.0 ? particle_steps / wall_seconds : 0.0; }
};

/// A task from its first to its last file; the steps between are made by others. Internal to dem_core.
class Compression {
 public:
  /// Builds the simulation, or reads the checkpoint that is to be gone on from. The task must outlive this.
  explicit Compression(const CompressTask& task);

  const CompressTask& task() const { return task_; }
  RunState& state() { return state_; }

  /// The test of this task, whose simulation `stepping` advances.
  Test test(Stepping& stepping);

  /// Keeps a checkpoint; the simulation must be true.
  void keep();
  bool checkpoint_due() const { return seconds_since(kept_at_) >= task_.options.checkpoint_every; }

  /// In so much of wall time, of which frames took a part.
  Performance performance(double wall_seconds, double frame_seconds) const;

  /// Writes what the test has come to.
  CompressResult result(const Performance& performance);

 private:
  void prepare();

  const CompressTask& task_;
  std::string identity_;
  RunState state_;
  std::int64_t first_step_ = 0;
  Clock::time_point kept_at_ = Clock::now();
  double checkpoint_seconds_ = 0.0;
};

}  // namespace pendular::dem_core
