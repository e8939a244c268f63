#include "diagnosis/inference/lanes.h"

#include <cmath>

namespace pendular::diagnosis {
namespace {

/// The numbers of all lanes as the compiler's vector, which it cuts into the registers that there are.
using Vector = double __attribute__((vector_size(sizeof(LaneNumbers)), may_alias));

constexpr std::size_t place(std::size_t row, std::size_t column) {
  return row * (row + 1) / 2 + column;
}

/// Inverts the square roots of a column's pivots.
inline __attribute__((always_inline)) void invert_root(Vector& pivot) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) pivot[lane] = 1.0 / std::sqrt(pivot[lane]);
}

/// Rows from `first` on, as many as kRows, of a column: several sums under way at once.
template <std::size_t kRows>
inline __attribute__((always_inline)) void factor_rows(Vector* rows, std::size_t first, std::size_t column) {
  Vector sums[kRows];
  const Vector* const pivot_row = rows + place(column, 0);
  for (std::size_t r = 0; r < kRows; ++r) sums[r] = rows[place(first + r, column)];
  for (std::size_t k = 0; k < column; ++k)
    for (std::size_t r = 0; r < kRows; ++r) sums[r] -= rows[place(first + r, k)] * pivot_row[k];
  for (std::size_t r = 0; r < kRows; ++r) rows[place(first + r, column)] = sums[r] * pivot_row[column];
}

inline __attribute__((always_inline)) void factor_all(Vector* rows, std::size_t size) {
  for (std::size_t column = 0; column < size; ++column) {
    Vector& pivot = rows[place(column, column)];
    for (std::size_t k = 0; k < column; ++k) pivot -= rows[place(column, k)] * rows[place(column, k)];
    invert_root(pivot);
    std::size_t row = column + 1;
    for (; row + 4 <= size; row += 4) factor_rows<4>(rows, row, column);
    for (; row < size; ++row) factor_rows<1>(rows, row, column);
  }
}

inline __attribute__((always_inline)) void squared_all(const Vector* rows, std::size_t size, const Vector* x,
                                                       Vector* solved, Vector& sum) {
  sum = Vector{};
  for (std::size_t row = 0; row < size; ++row) {
    Vector left = x[row], right = Vector{};  // two sums under way at once
    std::size_t k = 0;
    for (; k + 2 <= row; k += 2) {
      left -= rows[place(row, k)] * solved[k];
      right += rows[place(row, k + 1)] * solved[k + 1];
    }
    if (k < row) left -= rows[place(row, k)] * solved[k];
    solved[row] = (left - right) * rows[place(row, row)];
    sum += solved[row] * solved[row];
  }
}

// The same arithmetic for three sets of instructions: products and sums are rounded each (no contraction).
void factor_anywhere(Vector* rows, std::size_t size) {
  factor_all(rows, size);
}
void squared_anywhere(const Vector* rows, std::size_t size, const Vector* x, Vector* solved, Vector& sum) {
  squared_all(rows, size, x, solved, sum);
}
#ifdef __x86_64__
__attribute__((target("avx2"))) void factor_avx2(Vector* rows, std::size_t size) {
  factor_all(rows, size);
}
__attribute__((target("avx2"))) void squared_avx2(const Vector* rows, std::size_t size, const Vector* x,
                                                  Vector* solved, Vector& sum) {
  squared_all(rows, size, x, solved, sum);
}
__attribute__((target("avx512f"))) void factor_avx512(Vector* rows, std::size_t size) {
  factor_all(rows, size);
}
__attribute__((target("avx512f"))) void squared_avx512(const Vector* rows, std::size_t size, const Vector* x,
                                                       Vector* solved, Vector& sum) {
  squared_all(rows, size, x, solved, sum);
}
#endif

struct Kernels {
  void (*factor)(Vector*, std::size_t);
  void (*squared)(const Vector*, std::size_t, const Vector*, Vector*, Vector&);
};

const Kernels& kernels() {
  static const Kernels best = [] {
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512f")) return Kernels{factor_avx512, squared_avx512};
    if (__builtin_cpu_supports("avx2")) return Kernels{factor_avx2, squared_avx2};
#endif
    return Kernels{factor_anywhere, squared_anywhere};
  }();
  return best;
}

Vector* vectors(LaneNumbers* numbers) {
  return reinterpret_cast<Vector*>(numbers);
}
const Vector* vectors(const LaneNumbers* numbers) {
  return reinterpret_cast<const Vector*>(numbers);
}

}  // namespace

LaneFactors::LaneFactors(Eigen::Index size)
    : size_(static_cast<std::size_t>(size)), rows_(place(size_, 0), LaneNumbers{}) {
  for (std::size_t row = 0; row < size_; ++row) rows_[place(row, row)].fill(1.0);
}

void LaneFactors::add(const Eigen::MatrixXd& matrix, const LaneNumbers& times) {
  for (std::size_t row = 0; row < size_; ++row)
    for (std::size_t column = 0; column <= row; ++column) {
      const double number = matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
      LaneNumbers& to = rows_[place(row, column)];
      for (std::size_t lane = 0; lane < kLanes; ++lane) to[lane] += number * times[lane];
    }
}

void LaneFactors::add_diagonal(std::size_t lane, const Eigen::VectorXd& diagonal) {
  for (std::size_t row = 0; row < size_; ++row)
    rows_[place(row, row)][lane] += diagonal[static_cast<Eigen::Index>(row)];
}

void LaneFactors::factor() {
  kernels().factor(vectors(rows_.data()), size_);
}

LaneNumbers LaneFactors::half_log_determinants() const {
  LaneNumbers sums{};
  for (std::size_t row = 0; row < size_; ++row)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] -= std::log(rows_[place(row, row)][lane]);
  return sums;
}

LaneNumbers LaneFactors::squared(const std::vector<LaneNumbers>& x) const {
  std::vector<LaneNumbers> solved(size_);
  LaneNumbers sum;
  kernels().squared(vectors(rows_.data()), size_, vectors(x.data()), vectors(solved.data()), *vectors(&sum));
  return sum;
}

}  // namespace pendular::diagnosis
