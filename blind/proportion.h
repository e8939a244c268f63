#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace pendular::blind {

/// So many of so many.
struct Proportion {
  std::size_t hits = 0, of = 0;

  void count(bool hit) { hits += hit, ++of; }
  double share() const;  ///< NaN of none
  /// 95 % interval of the share behind it, by Wilson (1927, J. Am. Stat. Assoc. 22, 209); 0 to 1 of none.
  std::pair<double, double> interval_95() const;
};

/// Probability that one of `positives` is larger than one of `negatives`, ties half: the area under the
/// receiver operating characteristic. NaN where either is empty.
double area_under_curve(const std::vector<double>& positives, const std::vector<double>& negatives);

/// NaN of none.
double mean(const std::vector<double>& values);

}  // namespace pendular::blind
