#include "diagnosis/bank/mean_row.h"

#include <cmath>

namespace pendular::diagnosis {

Eigen::VectorXd mean_row(const std::vector<Eigen::VectorXd>& rows, Eigen::Index size) {
  Eigen::VectorXd mean = Eigen::VectorXd::Constant(size, std::nan(""));
  for (Eigen::Index f = 0; f < size; ++f) {
    double sum = 0.0, count = 0.0;
    for (const auto& row : rows)
      if (std::isfinite(row[f])) sum += row[f], count += 1.0;
    if (count > 0.0) mean[f] = sum / count;
  }
  return mean;
}

}  // namespace pendular::diagnosis
