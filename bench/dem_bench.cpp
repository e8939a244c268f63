// Particle-steps per second of the compression of sample A's specimen, on one thread and on two.
//
//   cmake --preset bench && cmake --build --preset bench && build-bench/bench/dem_bench
//
// The ratio of the two lines is the figure to quote; absolute rates belong to a machine.

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "dem_core/compress.h"
#include "dem_core/stepper.h"
#include "packing/bridges.h"
#include "packing/generate.h"

namespace pendular {
namespace {

Simulation loaded_specimen() {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  Packing packing = generate_packing(sample, 1);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  Simulation simulation = build_simulation(realise(packing, sample, 1), sample);
  Stepper stepper(simulation);
  while (simulation.strain() < 5e-3) stepper.step();  // all beads carry load
  return simulation;
}

void compression_steps(benchmark::State& state) {
  static const Simulation loaded = loaded_specimen();
  set_threads(static_cast<int>(state.range(0)));
  Simulation simulation = loaded;
  Stepper stepper(simulation);
  for (auto _ : state) stepper.step();
  state.counters["particle_steps"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(simulation.beads.size()),
      benchmark::Counter::kIsRate);
}

BENCHMARK(compression_steps)
    ->Arg(1)
    ->Arg(2)
    ->ArgName("threads")
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond)
    ->Repetitions(3);

}  // namespace
}  // namespace pendular

BENCHMARK_MAIN();
