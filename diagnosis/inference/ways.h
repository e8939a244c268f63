#pragma once

#include <array>
#include <vector>

#include "diagnosis/inference/reduced_space.h"

namespace pendular::diagnosis {

constexpr std::size_t kMostWays = 6;

/// One way in which an explanation at some magnitude may come out: how large the response's own covariance
/// is, and which reading of the law the specimen follows.
struct Way {
  double log_prior = 0.0;
  Prediction prediction;
};

/// The ways of an explanation: the standard deviations of the response's own covariance, what it has outside
/// the span included (`drawn_outside`, a square), at 0.4 to 2.5 times their size under the law as it is
/// believed, and as they are under other readings of it. At most kMostWays.
std::vector<Way> ways_of(const ReducedSpace& space, const Eigen::VectorXd& response, const Errors& errors,
                         double drawn_outside);

/// How well an explanation fits, over all of its ways.
struct WaysFit {
  double log_likelihood = 0.0;
  std::array<double, kMostWays> chi_squareds = {};  ///< of each way
  double chi_squared = 0.0;                         ///< of the most probable way
};

WaysFit fit(const ReducedSpace& space, const ReducedGap& gap, const std::vector<Way>& ways);

/// The logarithm of the likelihood beside something unknown: mean over the widths of the noise within the
/// span and outside it, of which at least one is larger. What is unknown may look like the known, or like
/// nothing that is known.
double beside_unknown(const ReducedSpace& space, const ReducedGap& gap, const std::vector<Way>& ways,
                      const WaysFit& fit);

}  // namespace pendular::diagnosis
