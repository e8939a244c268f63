#pragma once

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/kinds/features.h"
#include "packing/packing.h"

namespace pendular::diagnosis {

/// A simulated field of displacements: of one run of the bank. µm, three rows a bead, rigid motion and scale
/// removed (Kind::field).
struct BankField {
  int member = 0;
  std::string id;  ///< of the effect or believed input that was changed; empty: none
  double theta = 0.0;
  Eigen::VectorXd values;
};

/// The beads that a scan followed, in the order of its field.
struct FollowedBeads {
  std::vector<Bead> beads;
  double cutoff = 0.0;    ///< gap up to which neighbours are pairs, m
  double sigma_um = 0.0;  ///< stated standard error of a component of a displacement
  double strain = 0.0;    ///< of the platen
};

/// Reads a field of some thousand displacements as some forty numbers that repeat from draw to draw of what
/// an effect leaves to chance.
///
/// A field is compared with the mean of the bank's fields without any change. The difference is projected on
/// the modes of the bank: the mean differences that each effect and input makes at its largest. What is left
/// of it, which holds what draws differ in and all that no effect makes, is read by its size in parts of the
/// specimen, and by how pairs of neighbours part, slide and close in it. Sizes are logarithms of root mean
/// squares, the stated noise taken off.
class FieldStatistics {
 public:
  FieldStatistics(const FollowedBeads& followed, const std::vector<BankField>& bank);

  std::size_t size() const { return names_.size(); }
  const std::vector<std::string>& names() const { return names_; }
  double strain() const { return followed_.strain; }
  Eigen::VectorXd operator()(const Eigen::VectorXd& field) const;

  /// Seeded noise of the stated size for a field, µm.
  Eigen::VectorXd noise(unsigned long seed) const;

  const Eigen::VectorXd& reference() const { return reference_; }
  const Eigen::MatrixXd& modes() const { return modes_; }  ///< orthonormal columns

 private:
  void learn_modes(const std::vector<BankField>& bank);
  void find_pairs();
  void find_parts();

  struct Pair {
    Eigen::Index a, b;  ///< rows of the first component
    Vec3 way;           ///< unit vector from the first to the second
    double opening;     ///< in the reference, µm
  };
  FollowedBeads followed_;
  Eigen::VectorXd reference_;
  Eigen::MatrixXd modes_;
  std::vector<Pair> pairs_;
  std::vector<std::pair<std::string, std::vector<Eigen::Index>>> parts_;  ///< beads' first rows
  std::vector<std::string> names_;
};

}  // namespace pendular::diagnosis
