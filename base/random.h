#pragma once

#include <cmath>
#include <cstdint>

namespace pendular {

/// Random numbers that are a function of (seed, counter) alone, so that any thread may draw any of them
/// and the result is the same. Mixing: splitmix64 (Steele, Lea & Flood 2014, OOPSLA).
inline std::uint64_t random_bits(std::uint64_t seed, std::uint64_t counter) {
  auto mix = [](std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  };
  return mix(mix(seed + 0x9e3779b97f4a7c15ULL) + (counter + 1) * 0x9e3779b97f4a7c15ULL);
}

/// Uniform in the open interval (0, 1).
inline double random_uniform(std::uint64_t seed, std::uint64_t counter) {
  return (static_cast<double>(random_bits(seed, counter) >> 11) + 0.5) * 0x1.0p-53;
}

/// Standard normal (Box–Muller), one number per counter.
inline double random_normal(std::uint64_t seed, std::uint64_t counter) {
  const double u = random_uniform(seed, 2 * counter);
  const double v = random_uniform(seed, 2 * counter + 1);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
}

}  // namespace pendular
