#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pendular {

/// Numbers that are computed side by side, each in a lane of a register.
constexpr std::size_t kLanes = 8;

/// The compiler's vector of them, which it cuts into the registers that there are.
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

/// The same in memory: what containers hold. Aligned for the widest registers, which alignof(Lanes) is not
/// everywhere.
struct alignas(kLanes * sizeof(double)) LaneNumbers : std::array<double, kLanes> {};

using LanesInMemory = Lanes __attribute__((may_alias));
inline __attribute__((always_inline)) LanesInMemory& lanes_of(LaneNumbers& numbers) {
  return reinterpret_cast<LanesInMemory&>(numbers);
}
inline __attribute__((always_inline)) const LanesInMemory& lanes_of(const LaneNumbers& numbers) {
  return reinterpret_cast<const LanesInMemory&>(numbers);
}

inline __attribute__((always_inline)) void set_root(const Lanes& square, Lanes& root) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) root[lane] = std::sqrt(square[lane]);
}

/// Signs are told by their bits: not every compiler makes instructions on whole registers of comparisons.
using LaneBits = long long __attribute__((vector_size(sizeof(Lanes))));

/// Replaces negative numbers by zero.
inline __attribute__((always_inline)) void set_positive_part(Lanes& numbers) {
  constexpr long long all_but_sign = 0x7fffffffffffffff;
  numbers = 0.5 * (numbers + (Lanes)((LaneBits)numbers & all_but_sign));
}

namespace lanes {
template <typename Kernel, typename... Arguments>
void run_anywhere(Arguments... arguments) {
  Kernel::run(arguments...);
}
#ifdef __x86_64__
template <typename Kernel, typename... Arguments>
__attribute__((target("avx2"))) void run_avx2(Arguments... arguments) {
  Kernel::run(arguments...);
}
template <typename Kernel, typename... Arguments>
__attribute__((target("avx512f"))) void run_avx512(Arguments... arguments) {
  Kernel::run(arguments...);
}
#endif
}  // namespace lanes

/// Kernel::run(arguments...) with the widest registers of this machine: always_inline, and so compiled for
/// each set of instructions. The same arithmetic for all of them: products and sums are rounded each (no
/// contraction).
template <typename Kernel, typename... Arguments>
void run_widest(Arguments... arguments) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f")) return lanes::run_avx512<Kernel>(arguments...);
  if (__builtin_cpu_supports("avx2")) return lanes::run_avx2<Kernel>(arguments...);
#endif
  lanes::run_anywhere<Kernel>(arguments...);
}

}  // namespace pendular
