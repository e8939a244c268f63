// Numbers that the laws are written in: one pair at a time (double) or as many as a vector register holds.
// Included once per instruction set (the way of Highway's -inl headers), so that a law's text is compiled for
// each.

#if defined(PENDULAR_DEM_CORE_NUMBERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PENDULAR_DEM_CORE_NUMBERS_INL_H
#undef PENDULAR_DEM_CORE_NUMBERS_INL_H
#else
#define PENDULAR_DEM_CORE_NUMBERS_INL_H
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "dem_core/law/law_parameters.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace pendular::dem_core {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE double mul_add(double a, double b, double c) {
  return a * b + c;
}
HWY_INLINE double neg_mul_add(double a, double b, double c) {
  return c - a * b;
}
HWY_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
HWY_INLINE double magnitude(double a) {
  return std::fabs(a);
}
HWY_INLINE double square_root(double a) {
  return std::sqrt(a);
}
HWY_INLINE double select(bool which, double yes, double no) {
  return which ? yes : no;
}
HWY_INLINE bool both(bool a, bool b) {
  return a && b;
}
HWY_INLINE bool either(bool a, bool b) {
  return a || b;
}
HWY_INLINE double same(double value, double /*like*/) {
  return value;
}

/// Pairs that a register holds.
constexpr std::size_t kLanes = HWY_LANES(double);
struct Lanes {
  using Tag = hn::ScalableTag<double>;
  hn::Vec<Tag> v;
};
struct LaneMask {
  hn::Mask<Lanes::Tag> m;
};

HWY_INLINE Lanes operator+(Lanes a, Lanes b) {
  return {hn::Add(a.v, b.v)};
}
HWY_INLINE Lanes operator-(Lanes a, Lanes b) {
  return {hn::Sub(a.v, b.v)};
}
HWY_INLINE Lanes operator-(Lanes a) {
  return {hn::Neg(a.v)};
}
HWY_INLINE Lanes operator*(Lanes a, Lanes b) {
  return {hn::Mul(a.v, b.v)};
}
HWY_INLINE Lanes operator/(Lanes a, Lanes b) {
  return {hn::Div(a.v, b.v)};
}
HWY_INLINE LaneMask operator>(Lanes a, Lanes b) {
  return {hn::Gt(a.v, b.v)};
}
HWY_INLINE LaneMask operator>=(Lanes a, Lanes b) {
  return {hn::Ge(a.v, b.v)};
}
HWY_INLINE LaneMask operator<=(Lanes a, Lanes b) {
  return {hn::Le(a.v, b.v)};
}
HWY_INLINE Lanes mul_add(Lanes a, Lanes b, Lanes c) {
  return {hn::MulAdd(a.v, b.v, c.v)};
}
HWY_INLINE Lanes neg_mul_add(Lanes a, Lanes b, Lanes c) {
  return {hn::NegMulAdd(a.v, b.v, c.v)};
}
HWY_INLINE Lanes larger(Lanes a, Lanes b) {
  return {hn::Max(a.v, b.v)};
}
HWY_INLINE Lanes magnitude(Lanes a) {
  return {hn::Abs(a.v)};
}
HWY_INLINE Lanes square_root(Lanes a) {
  return {hn::Sqrt(a.v)};
}
HWY_INLINE Lanes select(LaneMask which, Lanes yes, Lanes no) {
  return {hn::IfThenElse(which.m, yes.v, no.v)};
}
HWY_INLINE LaneMask both(LaneMask a, LaneMask b) {
  return {hn::And(a.m, b.m)};
}
HWY_INLINE LaneMask either(LaneMask a, LaneMask b) {
  return {hn::Or(a.m, b.m)};
}
HWY_INLINE bool any(LaneMask a) {
  return !hn::AllFalse(Lanes::Tag(), a.m);
}
HWY_INLINE Lanes same(double value, Lanes /*like*/) {
  return {hn::Set(Lanes::Tag(), value)};
}

/// Whole numbers, as many as `Lanes` has.
struct WholeLanes {
  using Tag = hn::RebindToSigned<Lanes::Tag>;
  hn::Vec<Tag> v;
};
HWY_INLINE WholeLanes operator+(WholeLanes a, WholeLanes b) {
  return {hn::Add(a.v, b.v)};
}
HWY_INLINE WholeLanes operator-(WholeLanes a, WholeLanes b) {
  return {hn::Sub(a.v, b.v)};
}
/// Doubles from 2^52 to 2^53 are whole numbers, and follow each other as their bits do.
constexpr double kMiddle = 0x1.8p52;

/// In its lowest 48 bits the whole number nearest to a·b, for a·b within ±2^47; the others are of no meaning.
HWY_INLINE WholeLanes nearest_in_48_bits(Lanes a, Lanes b) {
  return {hn::BitCast(WholeLanes::Tag(), hn::MulAdd(a.v, b.v, hn::Set(Lanes::Tag(), kMiddle)))};
}
/// Into `to`: GCC 12 returns such a struct through memory, in pieces.
HWY_INLINE void put_nearest_in_48_bits(Lanes a, const Triple<Lanes>& b, Triple<WholeLanes>& to) {
  to.x = nearest_in_48_bits(a, b.x), to.y = nearest_in_48_bits(a, b.y), to.z = nearest_in_48_bits(a, b.z);
}
/// The number in the lowest 48 bits.
template <class D, class V>
HWY_INLINE hn::Vec<D> from_48_bits(D to, V whole) {
  constexpr double kLowest = 0x1p52,
                   kShift = 0x1p47;  // from 2^52 on, doubles have whole numbers as last bits
  const hn::RebindToSigned<D> bits;
  const auto shifted = hn::And(hn::Add(whole, hn::Set(bits, std::int64_t{1} << 47)),
                               hn::Set(bits, (std::int64_t{1} << 48) - 1));
  const auto above = hn::BitCast(to, hn::Or(shifted, hn::BitCast(bits, hn::Set(to, kLowest))));
  return hn::Sub(above, hn::Set(to, kLowest + kShift));
}
/// In all bits the whole number nearest to a·b, for a·b within ±2^51.
HWY_INLINE WholeLanes nearest(Lanes a, Lanes b) {
  const WholeLanes::Tag tag;
  return nearest_in_48_bits(a, b) - WholeLanes{hn::BitCast(tag, hn::Set(Lanes::Tag(), kMiddle))};
}

template <typename Real>
HWY_INLINE Triple<Real> operator+(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename Real>
HWY_INLINE Triple<Real> operator-(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename Real>
HWY_INLINE Triple<Real> operator-(const Triple<Real>& a) {
  return {-a.x, -a.y, -a.z};
}
template <typename Real>
HWY_INLINE Triple<Real> operator*(Real s, const Triple<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
/// b + s a
template <typename Real>
HWY_INLINE Triple<Real> mul_add(Real s, const Triple<Real>& a, const Triple<Real>& b) {
  return {mul_add(s, a.x, b.x), mul_add(s, a.y, b.y), mul_add(s, a.z, b.z)};
}
template <typename Real>
HWY_INLINE Real dot(const Triple<Real>& a, const Triple<Real>& b) {
  return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
/// b − s a
template <typename Real>
HWY_INLINE Triple<Real> neg_mul_add(Real s, const Triple<Real>& a, const Triple<Real>& b) {
  return {neg_mul_add(s, a.x, b.x), neg_mul_add(s, a.y, b.y), neg_mul_add(s, a.z, b.z)};
}
template <typename Real>
HWY_INLINE Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b) {
  return {neg_mul_add(a.z, b.y, a.y * b.z), neg_mul_add(a.x, b.z, a.z * b.x),
          neg_mul_add(a.y, b.x, a.x * b.y)};
}
/// c + a × b
template <typename Real>
HWY_INLINE Triple<Real> cross_add(const Triple<Real>& a, const Triple<Real>& b, const Triple<Real>& c) {
  return {neg_mul_add(a.z, b.y, mul_add(a.y, b.z, c.x)), neg_mul_add(a.x, b.z, mul_add(a.z, b.x, c.y)),
          neg_mul_add(a.y, b.x, mul_add(a.x, b.y, c.z))};
}
template <typename Mask, typename Real>
HWY_INLINE Triple<Real> select(Mask which, const Triple<Real>& yes, const Triple<Real>& no) {
  return {select(which, yes.x, no.x), select(which, yes.y, no.y), select(which, yes.z, no.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace pendular::dem_core
HWY_AFTER_NAMESPACE();

#endif
