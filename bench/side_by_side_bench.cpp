// Runs of a bank side by side in the lanes of a register, beside one run alone on one thread, in turns: two
// small packings whose beads are moved by 0.1 um and whose bonds differ in stiffness from run to run, under
// load, pairs listed anew as they come.
//
//   cmake --build --preset bench --target side_by_side_bench && build-bench/bench/side_by_side_bench

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "base/parallel.h"
#include "base/random.h"
#include "dem_core/compress.h"
#include "dem_core/step/side_by_side.h"
#include "dem_core/step/step_kernels.h"
#include "dem_core/step/stepper.h"
#include "packing/bridges.h"
#include "packing/generate.h"

namespace pendular {
namespace {

using dem_core::SideBySide;
using dem_core::Simulation;
using dem_core::Stepper;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Each compressed by half a per cent; `share` of sample A's volume.
std::vector<Simulation> loaded_bank(double share) {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  sample.contact.bond_friction_limit = false;
  sample.specimen.diameter *= std::cbrt(share);
  sample.specimen.height *= std::cbrt(share);
  Packing packing = generate_packing(sample, 1);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  packing = dem_core::realise(packing, sample, 1);
  std::vector<Simulation> bank;
  for (std::size_t run = 0; run < dem_core::kRuns; ++run) {
    Packing moved = packing;
    for (std::size_t k = 0; k < moved.beads.size(); ++k)
      for (int axis = 0; axis < 3; ++axis)
        moved.beads[k].centre[axis] += 1e-7 * random_normal(run, 3 * k + static_cast<std::size_t>(axis));
    Sample own = sample;
    own.bridges.normal_stiffness = 5760.0 * (1.0 - 0.01 * static_cast<double>(run));
    bank.push_back(dem_core::build_simulation(moved, own));
    Stepper stepper(bank.back());
    while (bank.back().strain() < 5e-3) stepper.step();
    stepper.store();
  }
  return bank;
}

/// Seconds of the processor for so many steps.
template <typename Steps>
double seconds_of(Steps& stepper, int steps) {
  const double start = processor_seconds();
  for (int k = 0; k < steps; ++k) stepper.step();
  return processor_seconds() - start;
}

void compare(const std::vector<Simulation>& loaded, const std::string& instruction_set) {
  constexpr int kSteps = 1000, kRepeats = 9;
  dem_core::use_instruction_set(instruction_set);
  const double beads = static_cast<double>(loaded.front().beads.size());
  std::vector<double> alone, together;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    std::vector<Simulation> bank = loaded;
    Simulation first = loaded.front();
    Stepper stepper(first);
    alone.push_back(1e-6 * beads * kSteps / seconds_of(stepper, kSteps));
    std::vector<Simulation*> runs;
    for (auto& simulation : bank) runs.push_back(&simulation);
    SideBySide all(runs);
    together.push_back(1e-6 * beads * kSteps * static_cast<double>(runs.size()) / seconds_of(all, kSteps));
  }
  std::sort(alone.begin(), alone.end());
  std::sort(together.begin(), together.end());
  fmt::print(
      "{}: {} beads, {} pairs, medians in M particle-steps/s: alone {:.1f}, side by side {:.1f}, ratio "
      "{:.2f}\n",
      instruction_set, beads, loaded.front().pairs.size(), alone[kRepeats / 2], together[kRepeats / 2],
      together[kRepeats / 2] / alone[kRepeats / 2]);
}

}  // namespace
}  // namespace pendular

int main() {
  using namespace pendular;
  set_threads(1);
  const auto sets = dem_core::instruction_sets();
  for (const double share : {0.08, 0.17}) {
    const auto loaded = loaded_bank(share);
    for (std::size_t k = 0; k < std::min<std::size_t>(2, sets.size()); ++k) compare(loaded, sets[k]);
  }
}
