#pragma once

#include <Eigen/Dense>
#include <vector>

namespace pendular::micromechanics {

/// Part of a symmetric positive definite system: a dense matrix over some unknowns, named by number.
struct Front {
  std::vector<int> unknowns;
  Eigen::MatrixXd matrix;  ///< only the lower triangle is kept up
};

/// Multifrontal elimination (Irons 1970; Duff & Reid 1983), for systems whose right-hand side is zero but for
/// the values of a few unknowns that are kept: parts are added into a front, unknowns that no other part
/// touches are eliminated, what is left is a part of the next front. Later the eliminated unknowns follow
/// from the kept ones.
class Elimination {
 public:
  /// `unknowns`: one more than the largest number of an unknown.
  explicit Elimination(int unknowns) : place_(static_cast<std::size_t>(unknowns), -1) {}

  /// Sum of the parts, less the unknowns for which `goes` is true.
  template <typename Goes>
  Front eliminate(const std::vector<Front>& parts, const Goes& goes) {
    std::vector<int> leaving, staying;
    for (const Front& part : parts)
      for (int unknown : part.unknowns) {
        if (place_[static_cast<std::size_t>(unknown)] != -1) continue;
        place_[static_cast<std::size_t>(unknown)] = 0;
        (goes(unknown) ? leaving : staying).push_back(unknown);
      }
    return eliminate(parts, std::move(leaving), std::move(staying));
  }

  /// Fills in every eliminated unknown, given the kept ones in `values`.
  void substitute_back(Eigen::VectorXd& values) const;

 private:
  struct Step {
    std::vector<int> leaving, staying;
    Eigen::MatrixXd factor;  ///< Cholesky factor of the leaving ones
    Eigen::MatrixXd cross;   ///< factor⁻¹ × the block between leaving and staying ones
  };
  Front eliminate(const std::vector<Front>& parts, std::vector<int> leaving, std::vector<int> staying);

  std::vector<int> place_;  ///< of an unknown in the front at hand; −1: absent
  std::vector<Step> steps_;
};

}  // namespace pendular::micromechanics
