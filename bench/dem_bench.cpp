// Particle-steps per second of the compression of sample A's specimen: one thread and two, every instruction
// set that this machine has, and a specimen ten times larger. Beside them what two threads cost by
// themselves: a parallel loop over nothing, and a line of memory that goes to the other core and back.
//
//   cmake --preset bench && cmake --build --preset bench && build-bench/bench/dem_bench
//
// Ratios of lines are the figures to quote; absolute rates belong to a machine.

#include <benchmark/benchmark.h>

#include <atomic>
#include <cmath>
#include <map>
#include <string>
#include <thread>

#include "base/parallel.h"
#include "dem_core/compress.h"
#include "dem_core/step/step_kernels.h"
#include "dem_core/step/stepper.h"
#include "packing/bridges.h"
#include "packing/generate.h"

namespace pendular {
namespace {

/// Sample A's cylinder, `times` as large in volume, compressed until all beads carry load.
const dem_core::Simulation& loaded_specimen(int times) {
  static std::map<int, dem_core::Simulation> made;
  if (const auto found = made.find(times); found != made.end()) return found->second;
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  sample.contact.bond_friction_limit = false;
  sample.specimen.diameter *= std::cbrt(times);
  sample.specimen.height *= std::cbrt(times);
  Packing packing = generate_packing(sample, 1);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  dem_core::Simulation simulation = dem_core::build_simulation(dem_core::realise(packing, sample, 1), sample);
  dem_core::Stepper stepper(simulation);
  while (simulation.strain() < 5e-3) stepper.step();
  stepper.store();
  return made.emplace(times, std::move(simulation)).first->second;
}

void measure(benchmark::State& state, int threads, int times, const std::string& set) {
  const dem_core::Simulation& loaded = loaded_specimen(times);
  dem_core::use_instruction_set(set);
  set_threads(threads);
  dem_core::Simulation simulation = loaded;
  dem_core::Stepper stepper(simulation);
  for (auto _ : state) stepper.step();
  state.counters["particle_steps"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(simulation.beads.size()),
      benchmark::Counter::kIsRate);
  state.counters["beads"] = static_cast<double>(simulation.beads.size());
  state.counters["pairs"] = static_cast<double>(simulation.pairs.size());
}

/// Pairs of sample A listed anew, where one bead in fifty flies as after failure.
void measure_listing(benchmark::State& state, int threads) {
  set_threads(threads);
  dem_core::Simulation simulation = loaded_specimen(1);
  for (std::size_t k = 0; k < simulation.beads.size(); k += 50)
    simulation.beads.velocity[k] = Vec3(1.0, 0.5, 0.0);
  dem_core::Stepper stepper(simulation);
  for (auto _ : state) {
    stepper.store();
    dem_core::list_pairs(simulation);
    stepper.load();
  }
  state.counters["pairs"] = static_cast<double>(simulation.pairs.size());
}

void measure_loop(benchmark::State& state) {
  set_threads(2);
  for (auto _ : state) for_shares(2, [](std::size_t) {});
}

void measure_line(benchmark::State& state) {
  alignas(64) std::atomic<bool> there{false};
  std::jthread other([&](const std::stop_token& stop) {
    while (!stop.stop_requested())
      if (there.load(std::memory_order_acquire)) there.store(false, std::memory_order_release);
  });
  for (auto _ : state) {
    there.store(true, std::memory_order_release);
    while (there.load(std::memory_order_acquire)) {
    }
  }
}

void add(const std::string& name, int threads, int times, const std::string& set) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { measure(state, threads, times, set); })
      ->UseRealTime()
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(0.3)
      ->Repetitions(5)
      ->ReportAggregatesOnly();
}

}  // namespace
}  // namespace pendular

int main(int argc, char** argv) {
  using namespace pendular;
  const auto sets = dem_core::instruction_sets();
  for (const auto& set : sets) add("sample_A/threads:1/" + set, 1, 1, set);
  add("sample_A/threads:2/" + sets.front(), 2, 1, sets.front());
  for (int threads : {1, 2})
    benchmark::RegisterBenchmark(("listing/threads:" + std::to_string(threads)).c_str(),
                                 [=](benchmark::State& state) { measure_listing(state, threads); })
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond)
        ->MinTime(0.3)
        ->Repetitions(5)
        ->ReportAggregatesOnly();
  for (int threads : {1, 2})
    add("ten_times_sample_A/threads:" + std::to_string(threads) + "/" + sets.front(), threads, 10,
        sets.front());
  benchmark::RegisterBenchmark("loop_over_nothing/threads:2", measure_loop)->UseRealTime()->Repetitions(5);
  benchmark::RegisterBenchmark("line_there_and_back", measure_line)->UseRealTime()->Repetitions(5);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
