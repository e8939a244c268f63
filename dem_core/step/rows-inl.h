// Between tables that hold a row of numbers per bead and registers that hold one number of several pairs
// each. Rows are turned into columns in registers: through memory a wide load would wait for the narrow
// stores before it.

#if defined(PENDULAR_DEM_CORE_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PENDULAR_DEM_CORE_ROWS_INL_H
#undef PENDULAR_DEM_CORE_ROWS_INL_H
#else
#define PENDULAR_DEM_CORE_ROWS_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include "dem_core/law/numbers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {

/// Rows of four numbers. A register may hold a whole row or part of it.
using Row = hn::CappedTag<double, 4>;
using WholeRow = hn::RebindToSigned<Row>;

/// Where in a table the rows of `kLanes` pairs begin.
using Places = const std::uint32_t*;

/// Three numbers of each pair, and a fourth.
struct Columns {
  Triple<Lanes> xyz;
  Lanes fourth;
};

/// Columns of the rows whose numbers from c on are part(p, c), p < kLanes.
template <typename Part>
HWY_INLINE Columns columns(const Part& part) {
  [[maybe_unused]] const Lanes::Tag tag;
#if HWY_MAX_BYTES == 64
  const auto ab = hn::Combine(tag, part(1, 0), part(0, 0)), cd = hn::Combine(tag, part(3, 0), part(2, 0));
  const auto ef = hn::Combine(tag, part(5, 0), part(4, 0)), gh = hn::Combine(tag, part(7, 0), part(6, 0));
  const auto xz = hn::ConcatEven(tag, cd, ab), yw = hn::ConcatOdd(tag, cd, ab);
  const auto xz_rest = hn::ConcatEven(tag, gh, ef), yw_rest = hn::ConcatOdd(tag, gh, ef);
  return {{{hn::ConcatEven(tag, xz_rest, xz)},
           {hn::ConcatEven(tag, yw_rest, yw)},
           {hn::ConcatOdd(tag, xz_rest, xz)}},
          {hn::ConcatOdd(tag, yw_rest, yw)}};
#elif HWY_MAX_BYTES == 32
  const auto a = part(0, 0), b = part(1, 0), c = part(2, 0), d = part(3, 0);
  const auto xz = hn::InterleaveLower(tag, a, b), yw = hn::InterleaveUpper(tag, a, b);
  const auto xz_rest = hn::InterleaveLower(tag, c, d), yw_rest = hn::InterleaveUpper(tag, c, d);
  return {{{hn::ConcatLowerLower(tag, xz_rest, xz)},
           {hn::ConcatLowerLower(tag, yw_rest, yw)},
           {hn::ConcatUpperUpper(tag, xz_rest, xz)}},
          {hn::ConcatUpperUpper(tag, yw_rest, yw)}};
#elif HWY_MAX_BYTES == 16
  const auto xy = part(0, 0), xy_next = part(1, 0), zw = part(0, 2), zw_next = part(1, 2);
  return {{{hn::InterleaveLower(tag, xy, xy_next)},
           {hn::InterleaveUpper(tag, xy, xy_next)},
           {hn::InterleaveLower(tag, zw, zw_next)}},
          {hn::InterleaveUpper(tag, zw, zw_next)}};
#else
  return {{{part(0, 0)}, {part(0, 1)}, {part(0, 2)}}, {part(0, 3)}};
#endif
}

/// Columns of the differences between four numbers of beads i and j.
HWY_INLINE Columns differences(const double* table, Places i, Places j) {
  const Row row;
  return columns([&](std::size_t p, std::size_t c) {
    return hn::Sub(hn::Load(row, table + i[p] + c), hn::Load(row, table + j[p] + c));
  });
}

HWY_INLINE Columns columns_of(const double* table, Places at) {
  return columns([&](std::size_t p, std::size_t c) { return hn::Load(Row(), table + at[p] + c); });
}

#if HWY_MAX_BYTES == 64

/// Differences between the first four numbers of rows of eight, and between the last four.
HWY_INLINE void differences(const double* table, Places i, Places j, Columns& first, Columns& last) {
  const Lanes::Tag tag;
  const auto of = [&](std::size_t p) {
    return hn::Sub(hn::Load(tag, table + i[p]), hn::Load(tag, table + j[p]));
  };
  const auto r0 = of(0), r1 = of(1), r2 = of(2), r3 = of(3), r4 = of(4), r5 = of(5), r6 = of(6), r7 = of(7);
  const auto e01 = hn::ConcatEven(tag, r1, r0), o01 = hn::ConcatOdd(tag, r1, r0);
  const auto e23 = hn::ConcatEven(tag, r3, r2), o23 = hn::ConcatOdd(tag, r3, r2);
  const auto e45 = hn::ConcatEven(tag, r5, r4), o45 = hn::ConcatOdd(tag, r5, r4);
  const auto e67 = hn::ConcatEven(tag, r7, r6), o67 = hn::ConcatOdd(tag, r7, r6);
  const auto x_low = hn::ConcatEven(tag, e23, e01), x_high = hn::ConcatEven(tag, e67, e45);
  const auto z_low = hn::ConcatOdd(tag, e23, e01), z_high = hn::ConcatOdd(tag, e67, e45);
  const auto y_low = hn::ConcatEven(tag, o23, o01), y_high = hn::ConcatEven(tag, o67, o45);
  const auto w_low = hn::ConcatOdd(tag, o23, o01), w_high = hn::ConcatOdd(tag, o67, o45);
  first.xyz = {{hn::ConcatEven(tag, x_high, x_low)},
               {hn::ConcatEven(tag, y_high, y_low)},
               {hn::ConcatEven(tag, z_high, z_low)}};
  first.fourth = {hn::ConcatEven(tag, w_high, w_low)};
  last.xyz = {{hn::ConcatOdd(tag, x_high, x_low)},
              {hn::ConcatOdd(tag, y_high, y_low)},
              {hn::ConcatOdd(tag, z_high, z_low)}};
  last.fourth = {hn::ConcatOdd(tag, w_high, w_low)};
}

#endif

using Whole = hn::Vec<WholeLanes::Tag>;

#if HWY_MAX_BYTES == 64

/// Of each pair a row: three numbers and zero, three more and zero.
HWY_INLINE void to_rows(const Triple<WholeLanes>& first, const Triple<WholeLanes>& last, Whole (&rows)[8]) {
  const WholeLanes::Tag tag;
  const auto zero = hn::Zero(tag);
  const auto four = [&](std::size_t p, Whole x, Whole y, Whole z) {
    const auto xy = hn::InterleaveLower(tag, x, y), xy_next = hn::InterleaveUpper(tag, x, y);
    const auto z0 = hn::InterleaveLower(tag, z, zero), z0_next = hn::InterleaveUpper(tag, z, zero);
    rows[p] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z0), xy);
    rows[p + 1] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z0_next), xy_next);
    rows[p + 2] = hn::OddEvenBlocks(z0, hn::SwapAdjacentBlocks(xy));
    rows[p + 3] = hn::OddEvenBlocks(z0_next, hn::SwapAdjacentBlocks(xy_next));
  };
  four(0, hn::ConcatLowerLower(tag, last.x.v, first.x.v), hn::ConcatLowerLower(tag, last.y.v, first.y.v),
       hn::ConcatLowerLower(tag, last.z.v, first.z.v));
  four(4, hn::ConcatUpperUpper(tag, last.x.v, first.x.v), hn::ConcatUpperUpper(tag, last.y.v, first.y.v),
       hn::ConcatUpperUpper(tag, last.z.v, first.z.v));
}

#else

/// Registers that hold one row of four.
constexpr std::size_t kParts = 4 / kLanes;

/// Of each pair a row: three numbers and zero.
HWY_INLINE void to_rows(const Triple<WholeLanes>& t, Whole (&rows)[kLanes][kParts]) {
  [[maybe_unused]] const WholeLanes::Tag tag;
  const auto zero = hn::Zero(tag);
#if HWY_MAX_BYTES == 32
  const auto xy = hn::InterleaveLower(tag, t.x.v, t.y.v), xy_next = hn::InterleaveUpper(tag, t.x.v, t.y.v);
  const auto z0 = hn::InterleaveLower(tag, t.z.v, zero), z0_next = hn::InterleaveUpper(tag, t.z.v, zero);
  rows[0][0] = hn::ConcatLowerLower(tag, z0, xy), rows[1][0] = hn::ConcatLowerLower(tag, z0_next, xy_next);
  rows[2][0] = hn::ConcatUpperUpper(tag, z0, xy), rows[3][0] = hn::ConcatUpperUpper(tag, z0_next, xy_next);
#elif HWY_MAX_BYTES == 16
  rows[0][0] = hn::InterleaveLower(tag, t.x.v, t.y.v), rows[0][1] = hn::InterleaveLower(tag, t.z.v, zero);
  rows[1][0] = hn::InterleaveUpper(tag, t.x.v, t.y.v), rows[1][1] = hn::InterleaveUpper(tag, t.z.v, zero);
#else
  rows[0][0] = t.x.v, rows[0][1] = t.y.v, rows[0][2] = t.z.v, rows[0][3] = zero;
#endif
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#endif
