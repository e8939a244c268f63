#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

#include "base/lanes.h"

namespace pendular::diagnosis {

/// Cholesky factors of symmetric positive definite matrices, one in each lane. What a lane computes depends
/// neither on the others nor on the machine's registers.
class LaneFactors {
 public:
  /// Identity matrices.
  explicit LaneFactors(Eigen::Index size);
  void reset();  ///< to identity matrices

  /// Adds to each lane's matrix so many times this one, of which the upper triangle is read. Before factor().
  void add(const Eigen::MatrixXd& matrix, const LaneNumbers& times);
  /// Adds to the diagonal of a lane's matrix. Before factor().
  void add_diagonal(std::size_t lane, const Eigen::VectorXd& diagonal);

  /// Replaces the matrices by their factors.
  void factor();

  /// Half the logarithm of each determinant.
  LaneNumbers half_log_determinants() const;
  /// xᵀ C⁻¹ x, with x of as many components as the matrices have rows. `solved`: room for as many.
  LaneNumbers squared(const std::vector<LaneNumbers>& x, std::vector<LaneNumbers>& solved) const;

 private:
  std::size_t size_;
  std::vector<LaneNumbers> rows_;  // of the lower triangles; of factors the diagonal is inverted
};

}  // namespace pendular::diagnosis
