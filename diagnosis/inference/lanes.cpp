#include "diagnosis/inference/lanes.h"

#include <algorithm>
#include <cmath>

namespace pendular::diagnosis {
namespace {

constexpr std::size_t kOfOneLogarithm = 8;  // pivots, whose product stays far from the smallest number

constexpr std::size_t place(std::size_t row, std::size_t column) {
  return row * (row + 1) / 2 + column;
}

struct AddTimes {
  static inline __attribute__((always_inline)) void run(LaneNumbers* rows, std::size_t size,
                                                        const double* columns, const LaneNumbers* times) {
    const Lanes by = lanes_of(*times);
    for (std::size_t row = 0; row < size; ++row)
      for (std::size_t column = 0; column <= row; ++column)
        lanes_of(rows[place(row, column)]) += columns[row * size + column] * by;
  }
};

/// Inverts the square roots of a column's pivots.
inline __attribute__((always_inline)) void invert_root(LanesInMemory& pivot) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) pivot[lane] = 1.0 / std::sqrt(pivot[lane]);
}

/// Rows from `first` on, as many as kRows, of a column: several sums under way at once.
template <std::size_t kRows>
inline __attribute__((always_inline)) void factor_rows(LaneNumbers* rows, std::size_t first,
                                                       std::size_t column) {
  Lanes sums[kRows];
  const LaneNumbers* const pivot_row = rows + place(column, 0);
  for (std::size_t r = 0; r < kRows; ++r) sums[r] = lanes_of(rows[place(first + r, column)]);
  for (std::size_t k = 0; k < column; ++k)
    for (std::size_t r = 0; r < kRows; ++r)
      sums[r] -= lanes_of(rows[place(first + r, k)]) * lanes_of(pivot_row[k]);
  for (std::size_t r = 0; r < kRows; ++r)
    lanes_of(rows[place(first + r, column)]) = sums[r] * lanes_of(pivot_row[column]);
}

struct Factor {
  static inline __attribute__((always_inline)) void run(LaneNumbers* rows, std::size_t size) {
    for (std::size_t column = 0; column < size; ++column) {
      LanesInMemory& pivot = lanes_of(rows[place(column, column)]);
      for (std::size_t k = 0; k < column; ++k) {
        const Lanes number = lanes_of(rows[place(column, k)]);
        pivot -= number * number;
      }
      invert_root(pivot);
      std::size_t row = column + 1;
      for (; row + 4 <= size; row += 4) factor_rows<4>(rows, row, column);
      for (; row < size; ++row) factor_rows<1>(rows, row, column);
    }
  }
};

struct Squared {
  static inline __attribute__((always_inline)) void run(const LaneNumbers* rows, std::size_t size,
                                                        const LaneNumbers* x, LaneNumbers* solved,
                                                        LaneNumbers* squared) {
    Lanes sum{};
    for (std::size_t row = 0; row < size; ++row) {
      const LaneNumbers* const factors = rows + place(row, 0);
      Lanes left = lanes_of(x[row]), right{};  // two sums under way at once
      std::size_t k = 0;
      for (; k + 2 <= row; k += 2) {
        left -= lanes_of(factors[k]) * lanes_of(solved[k]);
        right += lanes_of(factors[k + 1]) * lanes_of(solved[k + 1]);
      }
      if (k < row) left -= lanes_of(factors[k]) * lanes_of(solved[k]);
      const Lanes number = (left - right) * lanes_of(factors[row]);
      lanes_of(solved[row]) = number;
      sum += number * number;
    }
    lanes_of(*squared) = sum;
  }
};

}  // namespace

LaneFactors::LaneFactors(Eigen::Index size) : size_(static_cast<std::size_t>(size)), rows_(place(size_, 0)) {
  reset();
}

void LaneFactors::reset() {
  std::fill(rows_.begin(), rows_.end(), LaneNumbers{});
  for (std::size_t row = 0; row < size_; ++row) rows_[place(row, row)].fill(1.0);
}

void LaneFactors::add(const Eigen::MatrixXd& matrix, const LaneNumbers& times) {
  run_widest<AddTimes>(rows_.data(), size_, matrix.data(), &times);  // by columns, which it holds in a piece
}

void LaneFactors::add_diagonal(std::size_t lane, const Eigen::VectorXd& diagonal) {
  for (std::size_t row = 0; row < size_; ++row)
    rows_[place(row, row)][lane] += diagonal[static_cast<Eigen::Index>(row)];
}

void LaneFactors::factor() {
  run_widest<Factor>(rows_.data(), size_);
}

LaneNumbers LaneFactors::half_log_determinants() const {
  LaneNumbers sums{};
  for (std::size_t first = 0; first < size_; first += kOfOneLogarithm) {
    LaneNumbers product = rows_[place(first, first)];
    for (std::size_t row = first + 1; row < std::min(size_, first + kOfOneLogarithm); ++row)
      for (std::size_t lane = 0; lane < kLanes; ++lane) product[lane] *= rows_[place(row, row)][lane];
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] -= std::log(product[lane]);
  }
  return sums;
}

LaneNumbers LaneFactors::squared(const std::vector<LaneNumbers>& x, std::vector<LaneNumbers>& solved) const {
  LaneNumbers sum;
  run_widest<Squared>(rows_.data(), size_, x.data(), solved.data(), &sum);
  return sum;
}

}  // namespace pendular::diagnosis
