#pragma once

#include <cmath>
#include <cstdint>

#include "dem_core/simulation.h"

namespace pendular::dem_core {

/// Sums over pairs are sums of whole numbers of these, so that no order of adding shows in them: neither
/// threads, nor when pairs were listed, nor which runs are advanced side by side enter the result. Powers of
/// two.
///
/// Sums of forces and torques are held by 48 bits, in which kernels add them: 2^47 quanta are what the
/// stiffest spring exerts by two diameters and more. Where motion diverges to there, they wrap around. An
/// energy that is lost in one step may have 2^51 quanta.
struct Quanta {
  double force, torque, energy;  ///< N, N m, J
};

inline Quanta quanta(const Simulation& simulation) {
  const double diameter = simulation.beads.mean_diameter(), force = simulation.stiffest * diameter;
  const auto power_of_two_above = [](double value) { return std::ldexp(1.0, std::ilogb(value) + 1); };
  return {0x1p-46 * power_of_two_above(force), 0x1p-46 * power_of_two_above(force * diameter),
          0x1p-59 * power_of_two_above(force * diameter)};
}

/// Numbers over one quantum.
struct PerQuantum {
  double force, torque, energy;
};
inline PerQuantum per_quantum(const Quanta& one) {
  return {1.0 / one.force, 1.0 / one.torque, 1.0 / one.energy};
}

/// Wraps around, as the kernels do.
inline void add(std::int64_t& sum, std::int64_t more) {
  sum = static_cast<std::int64_t>(static_cast<std::uint64_t>(sum) + static_cast<std::uint64_t>(more));
}

}  // namespace pendular::dem_core
