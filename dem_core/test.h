#pragma once

#include <cstdint>
#include <vector>

#include "base/files.h"
#include "base/sample.h"
#include "dem_core/drive/relaxation.h"
#include "dem_core/run_state.h"
#include "dem_core/step/stepper.h"

namespace pendular::dem_core {

/// One compression test from its first to its last step: drives the platen, and writes down what is observed.
/// Whoever advances the simulation does so between before_step() and after_step().
class Test {
 public:
  Test(RunState& state, const Sample& sample, const BondEvolution& evolution, const fs::path& folder,
       std::vector<std::int64_t> ids, Stepping& stepping);

  /// Writes the frame that is due, and sets the platen's speed.
  void before_step();

  /// Lets bonds change, and books the step. ComputationFailed where motion has diverged.
  void after_step();

  /// Instead of both, where the sample asks for relaxation: an increment and its row. Interrupted on its way
  /// it leaves the state as it was before.
  void relax(Stepper& stepper);

  /// Makes the simulation true, for a checkpoint.
  void store() { stepping_.store(); }

  /// Share of the way, for progress.
  double done() const { return program_.done(state_.simulation, last_stress()); }

  double last_stress() const { return state_.rows.empty() ? 0.0 : state_.rows.back().stress; }

  /// Wall time spent on frames, s.
  double output_seconds() const { return output_seconds_; }

 private:
  bool relax_by(Stepper& stepper, const Increment& increment);
  void close_row();
  void require_sane(const Energies& now) const;
  void write_due_frames();
  void write_next_frame();
  void finish();

  RunState& state_;
  const Sample& sample_;
  const BondEvolution& evolution_;
  fs::path folder_;
  std::vector<std::int64_t> ids_;
  std::vector<double> frame_strains_;
  PlatenProgram program_;
  Stepping& stepping_;
  int steps_per_row_ = 1;
  std::int64_t steps_per_change_ = 1;
  double output_seconds_ = 0.0;
};

}  // namespace pendular::dem_core
