// Young's modulus of sample A's specimen as a linear structure, beside the limit of two seconds for 8,000
// beads, with one thread and with two.
//
//   cmake --preset bench && cmake --build --preset bench && build-bench/bench/linear_bench

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "base/parallel.h"
#include "dem_core/compress.h"
#include "dem_core/linear/linear_response.h"
#include "packing/bridges.h"
#include "packing/generate.h"

namespace pendular {
namespace {

constexpr double kLimitSeconds = 2.0;
constexpr int kRepetitions = 3;

dem_core::Simulation specimen() {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  sample.contact.bond_friction_limit = false;
  sample.specimen.volume_fraction = 0.62;
  Packing packing = generate_packing(sample, 1);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  return dem_core::build_simulation(dem_core::realise(packing, sample, 1), sample);
}

void measure(const dem_core::Simulation& simulation, double strain, int threads) {
  set_threads(threads);
  std::vector<double> seconds;
  dem_core::LinearResponse response;
  for (int k = 0; k < kRepetitions; ++k) {
    const auto start = std::chrono::steady_clock::now();
    response = dem_core::linear_response(simulation, {strain});
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  const dem_core::ContactCount& c = response.contacts;
  fmt::print(
      "strain {:.3f}, {} thread(s): {:.2f} s (limit {:.1f}), E {:.2f} MPa, Poisson ratio {:.3f}, stress "
      "{:.4f} "
      "MPa\n    {} rounds, {} iterations, {} bonds, {} touching, {} + {} on platens, {} sliding ({:+.2f} % "
      "of E), "
      "load {:+.2f} % of E, {} breaking\n",
      strain, threads, *std::min_element(seconds.begin(), seconds.end()), kLimitSeconds,
      1e-6 * response.modulus, response.poisson_ratio, 1e-6 * response.stress, response.rounds,
      response.iterations, c.bonds, c.touching, c.bottom, c.top, c.sliding, 100.0 * response.sliding_effect,
      100.0 * response.load_effect, c.breaking);
}

}  // namespace
}  // namespace pendular

int main() {
  using namespace pendular;
  const dem_core::Simulation simulation = specimen();
  fmt::print("{} beads\n", simulation.beads.size());
  for (double strain : {0.02, 0.03, 0.04, 0.05})
    for (int threads : {1, 2}) measure(simulation, strain, threads);
}
