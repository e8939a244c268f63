#include "diagnosis/kinds/evenness.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

#include "base/distributions.h"

namespace pendular::diagnosis {
namespace {

constexpr Eigen::Index kTerms = 10;  // beside the mean

Eigen::RowVectorXd terms(const Columns& places, std::size_t pair) {
  const auto at = [&](int column) { return places.at(kPlaceColumns[column])[pair]; };
  const double x = at(0), y = at(1), z = at(2), cosine = at(3);
  Eigen::RowVectorXd row(kTerms);
  row << x, y, z, x * x, y * y, z * z, x * y, x * z, y * z, cosine * cosine;
  return row;
}

/// How many rows have the rarer of two states; all rows where values are no states.
std::size_t rarer(const std::vector<double>& values, const std::vector<std::size_t>& rows) {
  const auto states = [&](double state) {
    return static_cast<std::size_t>(
        std::count_if(rows.begin(), rows.end(), [&](std::size_t k) { return values[k] == state; }));
  };
  const std::size_t none = states(0.0), joined = states(1.0);
  return none + joined == rows.size() ? std::min(none, joined) : rows.size();
}

}  // namespace

double evenness(const Columns& places, const std::vector<double>& values, double tolerated,
                std::size_t least) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (std::isfinite(values[k])) rows.push_back(k);
  if (rows.size() < least || rarer(values, rows) < least) return 1.0;
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix(n, kTerms);
  Eigen::VectorXd value(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const std::size_t pair = rows[static_cast<std::size_t>(r)];
    matrix.row(r) = terms(places, pair), value[r] = values[pair];
  }
  matrix.rowwise() -= matrix.colwise().mean().eval();
  value.array() -= value.mean();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  const double whole = value.squaredNorm();
  if (qr.rank() == 0 || !(whole > 0.0)) return 1.0;
  const Eigen::VectorXd along = qr.householderQ().transpose() * value;
  const double squares = along.head(qr.rank()).squaredNorm(), rows_used = static_cast<double>(n);
  if (squares <= rows_used * tolerated * tolerated) return 1.0;
  return chi_squared_tail(rows_used * squares / whole, static_cast<double>(qr.rank()));
}

}  // namespace pendular::diagnosis
