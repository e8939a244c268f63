#include "micromechanics/fronts.h"

#include "base/error.h"

namespace pendular::micromechanics {
namespace {

Eigen::VectorXd gather(const Eigen::VectorXd& values, const std::vector<int>& unknowns) {
  Eigen::VectorXd some(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t k = 0; k < unknowns.size(); ++k) some[static_cast<Eigen::Index>(k)] = values[unknowns[k]];
  return some;
}

}  // namespace

Front Elimination::eliminate(const std::vector<Front>& parts, std::vector<int> leaving,
                             std::vector<int> staying) {
  const auto m = static_cast<Eigen::Index>(leaving.size()), n = static_cast<Eigen::Index>(staying.size());
  int next = 0;
  for (const auto* list : {&leaving, &staying})
    for (int unknown : *list) place_[static_cast<std::size_t>(unknown)] = next++;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m + n, m + n);
  for (const Front& part : parts) {
    const auto size = static_cast<Eigen::Index>(part.unknowns.size());
    std::vector<int> at;
    for (int unknown : part.unknowns) at.push_back(place_[static_cast<std::size_t>(unknown)]);
    for (Eigen::Index c = 0; c < size; ++c)
      for (Eigen::Index r = c; r < size; ++r) {
        const int row = at[static_cast<std::size_t>(r)], column = at[static_cast<std::size_t>(c)];
        sum(std::max(row, column), std::min(row, column)) += part.matrix(r, c);
      }
  }
  for (const auto* list : {&leaving, &staying})
    for (int unknown : *list) place_[static_cast<std::size_t>(unknown)] = -1;

  Step step{std::move(leaving), std::move(staying), sum.topLeftCorner(m, m), sum.bottomLeftCorner(n, m)};
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(step.factor);
  if (cholesky.info() != Eigen::Success)
    throw ComputationFailed("finite elements of a bridge: the stiffness matrix is not positive definite");
  cholesky.matrixL().transpose().solveInPlace<Eigen::OnTheRight>(step.cross);
  Front rest{step.staying, sum.bottomRightCorner(n, n)};
  rest.matrix.selfadjointView<Eigen::Lower>().rankUpdate(step.cross, -1.0);
  steps_.push_back(std::move(step));
  return rest;
}

void Elimination::substitute_back(Eigen::VectorXd& values) const {
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    Eigen::VectorXd found = -step->cross.transpose() * gather(values, step->staying);
    step->factor.triangularView<Eigen::Lower>().transpose().solveInPlace(found);
    for (std::size_t k = 0; k < step->leaving.size(); ++k)
      values[step->leaving[k]] = found[static_cast<Eigen::Index>(k)];
  }
}

}  // namespace pendular::micromechanics
