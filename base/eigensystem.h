#pragma once

#include <Eigen/Core>

namespace pendular {

/// Eigenvalues of a symmetric matrix, rising, and the vectors in the columns that belong to them.
struct Eigensystem {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Of the lower triangle. Compiled once: Eigen's solver costs each file that uses it six seconds.
Eigensystem eigensystem(const Eigen::MatrixXd& symmetric);

}  // namespace pendular
