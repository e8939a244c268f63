#include "diagnosis/emulator.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pendular::diagnosis {
namespace {

constexpr int kDegree = 2;
constexpr double kFitted = 0.1;                       // of a residual that the fit leaves no room for
constexpr double kOutlier = 2.5, kOfMedian = 1.4826;  // of a normal's standard deviation
constexpr double kOfTheFit = 2.0 / 3.0;  // parameters over runs of an effect: the fit's own variance

/// Columns that an id has in the design: powers of θ over its largest |θ|, which keeps them alike in size.
struct Powers {
  Eigen::Index first = 0;
  int degree = 0;
  double scale = 1.0;
};

struct Design {
  std::vector<int> members;
  std::vector<std::string> ids;
  std::map<std::string, Powers> powers;
  Eigen::MatrixXd matrix;
};

Design design_of(const std::vector<DesignRun>& runs) {
  Design design;
  std::map<std::string, std::set<double>> magnitudes;
  for (const auto& run : runs) {
    if (std::find(design.members.begin(), design.members.end(), run.member) == design.members.end())
      design.members.push_back(run.member);
    if (run.id.empty()) continue;
    if (!magnitudes.contains(run.id)) design.ids.push_back(run.id);
    magnitudes[run.id].insert(run.theta);
  }
  auto columns = static_cast<Eigen::Index>(design.members.size());
  for (const auto& id : design.ids) {
    const auto& thetas = magnitudes[id];
    Powers powers{columns, thetas.size() >= 3 ? kDegree : 1, 0.0};
    for (double theta : thetas) powers.scale = std::max(powers.scale, std::fabs(theta));
    design.powers[id] = powers;
    columns += powers.degree;
  }
  design.matrix = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(runs.size()), columns);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const auto member = std::find(design.members.begin(), design.members.end(), runs[k].member);
    design.matrix(row, member - design.members.begin()) = 1.0;
    if (runs[k].id.empty()) continue;
    const Powers& powers = design.powers[runs[k].id];
    for (int n = 0; n < powers.degree; ++n)
      design.matrix(row, powers.first + n) = std::pow(runs[k].theta / powers.scale, n + 1);
  }
  return design;
}

/// The rows of runs that show a feature.
std::vector<Eigen::Index> showing(const std::vector<DesignRun>& runs, Eigen::Index feature) {
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (std::isfinite(runs[k].values[feature])) rows.push_back(static_cast<Eigen::Index>(k));
  return rows;
}

/// Residuals, those drawn in that stand out: a few runs that a polynomial cannot follow (an effect at its
/// largest) say nothing of the scatter of the others.
Eigen::VectorXd without_outliers(Eigen::VectorXd left, const Eigen::MatrixXd& matrix,
                                 const Eigen::MatrixXd& inverse) {
  std::vector<double> sizes;
  Eigen::VectorXd expected(left.size());  // standard deviation over that of the scatter
  for (Eigen::Index r = 0; r < left.size(); ++r) {
    expected[r] = std::sqrt(std::max(0.0, 1.0 - matrix.row(r).dot(inverse.col(r))));
    if (expected[r] > kFitted) sizes.push_back(std::fabs(left[r]) / expected[r]);
  }
  if (sizes.empty()) return left;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double most = kOutlier * kOfMedian * *middle;
  for (Eigen::Index r = 0; r < left.size(); ++r)
    left[r] = std::clamp(left[r], -most * expected[r], most * expected[r]);
  return left;
}

}  // namespace

const Signature* Responses::find(const std::string& id) const {
  const auto found =
      std::find_if(signatures.begin(), signatures.end(), [&](const Signature& s) { return s.id == id; });
  return found == signatures.end() ? nullptr : &*found;
}

Responses fit_responses(const std::vector<DesignRun>& runs, Eigen::Index features) {
  const Design design = design_of(runs);
  Responses responses;
  responses.members = design.members;
  const auto members = static_cast<Eigen::Index>(design.members.size());
  responses.offsets = Eigen::MatrixXd::Zero(members, features);
  for (const auto& id : design.ids) {
    Signature signature;
    signature.id = id;
    signature.powers.assign(static_cast<std::size_t>(design.powers.at(id).degree),
                            Eigen::VectorXd::Zero(features));
    responses.signatures.push_back(signature);
  }
  Eigen::MatrixXd residuals = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(runs.size()), features);
  for (Eigen::Index f = 0; f < features; ++f) {
    const auto rows = showing(runs, f);
    if (rows.empty()) continue;
    Eigen::VectorXd values(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r)
      values[static_cast<Eigen::Index>(r)] = runs[static_cast<std::size_t>(rows[r])].values[f];
    const Eigen::MatrixXd matrix = design.matrix(rows, Eigen::all);
    // Least norm where runs are too few for all coefficients: what is not seen has no response.
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(matrix);
    const Eigen::VectorXd found = solver.solve(values);
    responses.offsets.col(f) = found.head(members);
    for (auto& signature : responses.signatures) {
      const Powers& powers = design.powers.at(signature.id);
      for (int n = 0; n < powers.degree; ++n)
        signature.powers[static_cast<std::size_t>(n)][f] =
            found[powers.first + n] / std::pow(powers.scale, n + 1);
    }
    const Eigen::VectorXd left = without_outliers(values - matrix * found, matrix, solver.pseudoInverse());
    for (std::size_t r = 0; r < rows.size(); ++r) residuals(rows[r], f) = left[static_cast<Eigen::Index>(r)];
    responses.freedom += static_cast<double>(values.size() - solver.rank()) / static_cast<double>(features);
  }
  const Eigen::MatrixXd centred = responses.offsets.rowwise() - responses.offsets.colwise().mean();
  responses.between = centred.transpose() * centred / std::max<double>(1.0, static_cast<double>(members - 1));
  responses.within = residuals.transpose() * residuals / std::max(1.0, responses.freedom);
  return responses;
}

Signature exact_signature(const std::string& id, const std::vector<double>& theta,
                          const std::vector<Eigen::VectorXd>& changes, int degree) {
  const auto count = static_cast<Eigen::Index>(theta.size());
  degree = std::min(degree, static_cast<int>(count));
  double scale = 0.0;
  for (double one : theta) scale = std::max(scale, std::fabs(one));
  Eigen::MatrixXd matrix(count, degree), values(count, changes.front().size());
  for (Eigen::Index r = 0; r < count; ++r) {
    const auto k = static_cast<std::size_t>(r);
    for (int n = 0; n < degree; ++n) matrix(r, n) = std::pow(theta[k] / scale, n + 1);
    values.row(r) = changes[k].transpose();
  }
  const Eigen::MatrixXd found = matrix.colPivHouseholderQr().solve(values);
  Signature signature;
  signature.id = id;
  for (int n = 0; n < degree; ++n)
    signature.powers.push_back(found.row(n).transpose() / std::pow(scale, n + 1));
  return signature;
}

Scatter scatter_of(const Responses& responses) {
  const double members = static_cast<double>(responses.members.size());
  const Eigen::MatrixXd between = (1.0 + 1.0 / members) * responses.between;
  const Eigen::MatrixXd within = (1.0 + kOfTheFit) * responses.within;
  Scatter scatter;
  scatter.covariance = between + within;
  const Eigen::VectorXd diagonal = scatter.covariance.diagonal().cwiseMax(1e-12);
  const double share = between.diagonal().cwiseQuotient(diagonal).mean();
  scatter.freedom = 1.0 / (share * share / std::max(1.0, members - 1.0) +
                           (1.0 - share) * (1.0 - share) / std::max(1.0, responses.freedom));
  const double size = static_cast<double>(diagonal.size());
  scatter.covariance *= scatter.freedom / (size + scatter.freedom);
  scatter.covariance.diagonal() = diagonal;
  return scatter;
}

}  // namespace pendular::diagnosis
