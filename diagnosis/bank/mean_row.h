#pragma once

#include <Eigen/Core>

#include <vector>

namespace pendular::diagnosis {

/// Mean of the rows that are finite, feature by feature; NaN where none is.
Eigen::VectorXd mean_row(const std::vector<Eigen::VectorXd>& rows, Eigen::Index size);

}  // namespace pendular::diagnosis
