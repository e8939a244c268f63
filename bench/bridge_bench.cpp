// Time of one bridge and of a packing's bridges, and how finite elements converge.
//
//   cmake --preset bench && cmake --build --preset bench && build-bench/bench/bridge_bench [--convergence]
//
// The ratios to the limits (50 ms on one core, 2 s on two) are the figures to quote; times belong to a
// machine.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "micromechanics/bridge_fe.h"
#include "micromechanics/stiffness.h"

namespace pendular {
namespace {

constexpr micromechanics::BridgeResolution kReference{
    .order = 8, .rim_layers = 4, .rim_ratio = 0.15, .rim_reach = 1.25, .axis_stride = 0.5};

template <typename Work>
double median_seconds(int repeats, const Work& work) {
  std::vector<double> times;
  for (int k = 0; k < repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats / 2)];
}

void time_one_bridge(const char* name, const micromechanics::BridgeBody& body,
                     const micromechanics::Polymer& polymer) {
  const double ms = 1e3 * median_seconds(31, [&] { micromechanics::bridge_stiffness(body, polymer); });
  fmt::print("{:<44} {:7.1f} ms, {:.2f} of 50 ms\n", name, ms, ms / 50.0);
}

std::vector<micromechanics::BridgeBody> packing_bridges() {
  std::vector<micromechanics::BridgeBody> bodies;
  for (std::uint64_t k = 0; k < 30000; ++k) {
    const auto draw = [&](std::uint64_t n) { return std::clamp(random_normal(1, 4 * k + n), -4.0, 4.0); };
    bodies.push_back({73.9e-6 + 12.7e-6 * draw(0), 200.9e-6 * (0.07 * random_uniform(2, k) - 0.006),
                      200.9e-6 * (1.0 + 0.05 * draw(1)), 200.9e-6 * (1.0 + 0.05 * draw(2))});
  }
  return bodies;
}

void time_packing(int threads) {
  set_threads(threads);
  const auto bodies = packing_bridges();
  double error = 0.0;
  const double seconds = median_seconds(5, [&] {
    error = micromechanics::bridge_stiffnesses(bodies, {1.5e6, 0.49}).interpolation_error;
  });
  fmt::print("{:<44} {:7.2f} s, {:.2f} of 2 s; interpolated to {:.2g} %\n",
             fmt::format("30,000 bridges, table included, {} thread(s)", threads), seconds, seconds / 2.0,
             100.0 * error);
}

/// Largest relative error of the four.
double error_of(const micromechanics::BondStiffness& k, const micromechanics::BondStiffness& exact) {
  return std::max({std::abs(k.normal / exact.normal - 1.0), std::abs(k.tangential / exact.tangential - 1.0),
                   std::abs(k.bending / exact.bending - 1.0), std::abs(k.twisting / exact.twisting - 1.0)});
}

void print_convergence() {
  fmt::print(
      "| d/D | gap/D | nu | order 2 | 3 | 4 | 5 (used) | 6 | 7 | estimate "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  struct Corner {
    double neck, gap, nu;
  };
  for (const Corner& c :
       {Corner{73.9 / 200.9, 2.0 / 200.9, 0.49}, Corner{0.1, 0.001, 0.0}, Corner{0.1, 0.001, 0.499},
        Corner{0.1, 0.1, 0.0}, Corner{0.1, 0.1, 0.499}, Corner{0.8, 0.001, 0.0}, Corner{0.8, 0.001, 0.499},
        Corner{0.8, 0.1, 0.0}, Corner{0.8, 0.1, 0.499}}) {
    const micromechanics::BridgeBody body{c.neck, c.gap, 1.0, 1.0};
    const micromechanics::Polymer polymer{1.0, c.nu};
    const micromechanics::BondStiffness exact =
        micromechanics::bridge_stiffness_on(body, polymer, kReference);
    fmt::print("| {:.3g} | {:.3g} | {} |", c.neck, c.gap, c.nu);
    for (int order = 2; order <= 7; ++order)
      fmt::print(" {:.1e} |",
                 error_of(micromechanics::bridge_stiffness_on(body, polymer, {.order = order}), exact));
    fmt::print(" {:.1e} |\n", micromechanics::bridge_stiffness(body, polymer).error_estimate);
  }
}

void print_range() {
  double error = 0.0, estimate = 0.0, ratio = 0.0;
  const int points = 400;
  for (std::uint64_t k = 0; k < points; ++k) {
    const micromechanics::BridgeBody body{0.1 + 0.7 * random_uniform(1, 3 * k),
                                          1e-3 * std::pow(100.0, random_uniform(1, 3 * k + 1)), 1.0, 1.0};
    // Half of them near incompressibility, half evenly.
    const double u = random_uniform(1, 3 * k + 2);
    const micromechanics::Polymer polymer{1.0, k % 2 ? 0.499 * u : 0.5 - 0.5 * std::pow(0.002, u)};
    const micromechanics::BridgeStiffness found = micromechanics::bridge_stiffness(body, polymer);
    const double e = error_of(found, micromechanics::bridge_stiffness_on(body, polymer, kReference));
    error = std::max(error, e);
    estimate = std::max(estimate, found.error_estimate);
    if (e > 1e-8) ratio = std::max(ratio, e / found.error_estimate);
  }
  fmt::print(
      "{} random bridges of the verified range: largest error {:.1e}, largest estimate {:.1e}, largest error "
      "over "
      "estimate {:.2f}\n",
      points, error, estimate, ratio);
}

}  // namespace
}  // namespace pendular

int main(int argc, char** argv) {
  using namespace pendular;
  if (argc > 1 && std::string(argv[1]) == "--convergence") {
    print_convergence();
    print_range();
    return 0;
  }
  set_threads(1);
  time_one_bridge("sample A", {73.9e-6, 2e-6, 200.9e-6, 200.9e-6}, {1.5e6, 0.49});
  time_one_bridge("d/D 0.8, gap/D 0.001, nu 0.499", {0.8, 0.001, 1.0, 1.0}, {1.0, 0.499});
  time_one_bridge("sample A between beads of 190 and 210 um", {73.9e-6, 2e-6, 190e-6, 210e-6}, {1.5e6, 0.49});
  time_packing(1);
  time_packing(2);
}
