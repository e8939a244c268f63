#pragma once

#include "blind/engine.h"
#include "blind/truth.h"

namespace pendular::blind {

/// A test of a case's specimen that another program is to make. Strains are as the instruments read them.
struct EngineTest {
  const Engine& engine;
  const Packing& reported;  ///< as run_truth() has it
  const Sample& sample;     ///< that is true of it
  std::uint64_t seed = 1;
  double max_strain = 0.0;
  double unload_at = 0.0, scan_at = 0.0;  ///< 0: not
};

/// Has it made. Beads are those that are, whatever the measurement made of them; all other effects are the
/// engine's own, and so are its draws: which bridges are missing, which necks they have.
TrueTest engine_truth(const EngineTest& test, const fs::path& scratch);

}  // namespace pendular::blind
