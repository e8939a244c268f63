#include "diagnosis/emulator.h"

#include <Eigen/Dense>

#include <cmath>
#include <set>

namespace pendular::diagnosis {
namespace {

/// Runs that show a feature.
std::vector<Eigen::Index> showing(const std::vector<PairedRun>& runs, Eigen::Index feature) {
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (std::isfinite(runs[k].change[feature])) rows.push_back(static_cast<Eigen::Index>(k));
  return rows;
}

int magnitudes(const std::vector<PairedRun>& runs, const std::vector<Eigen::Index>& rows) {
  std::set<double> different;
  for (const Eigen::Index row : rows) different.insert(runs[static_cast<std::size_t>(row)].theta);
  return static_cast<int>(different.size());
}

}  // namespace

FittedSignature fit_signature(const std::string& id, const std::vector<PairedRun>& runs,
                              Eigen::Index features) {
  FittedSignature fitted;
  fitted.signature.id = id;
  fitted.signature.linear = fitted.signature.curved = Eigen::VectorXd::Zero(features);
  fitted.residuals = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(runs.size()), features);
  for (Eigen::Index f = 0; f < features; ++f) {
    const auto rows = showing(runs, f);
    const int different = magnitudes(runs, rows), parameters = different >= 3 ? 2 : std::min(different, 1);
    if (parameters < 1) continue;
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd powers(count, parameters);
    Eigen::VectorXd change(count);
    for (Eigen::Index r = 0; r < count; ++r) {
      const PairedRun& run = runs[static_cast<std::size_t>(rows[static_cast<std::size_t>(r)])];
      powers(r, 0) = run.theta;
      if (parameters == 2) powers(r, 1) = run.theta * run.theta;
      change[r] = run.change[f];
    }
    const Eigen::VectorXd found = powers.colPivHouseholderQr().solve(change);
    fitted.signature.linear[f] = found[0];
    if (parameters == 2) fitted.signature.curved[f] = found[1];
    const Eigen::VectorXd left = change - powers * found;
    for (Eigen::Index r = 0; r < count; ++r) fitted.residuals(rows[static_cast<std::size_t>(r)], f) = left[r];
    fitted.freedom += static_cast<double>(count - parameters) / static_cast<double>(features);
  }
  return fitted;
}

PooledCovariance pooled_covariance(const std::vector<Eigen::MatrixXd>& residuals, double freedom) {
  PooledCovariance pooled;
  pooled.freedom = freedom;
  if (residuals.empty() || freedom <= 0.0) return pooled;
  const Eigen::Index size = residuals.front().cols();
  pooled.covariance = Eigen::MatrixXd::Zero(size, size);
  for (const auto& block : residuals) pooled.covariance += block.transpose() * block / freedom;
  const double shrink = static_cast<double>(size) / (static_cast<double>(size) + freedom);
  const Eigen::VectorXd diagonal = pooled.covariance.diagonal();
  pooled.covariance *= 1.0 - shrink;
  pooled.covariance.diagonal() = diagonal;
  return pooled;
}

}  // namespace pendular::diagnosis
