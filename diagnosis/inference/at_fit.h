#pragma once

#include <Eigen/Core>

#include <string>

#include "diagnosis/bank/signature.h"
#include "diagnosis/inference/reduced_space.h"

namespace pendular::diagnosis {

/// What runs at the best fit of an explanation show beyond what responses add up to: `rows`, three or more,
/// the features of each run less that. In the directions of the evidence, in units of the noise, it is N(0,
/// p²) with the likeliest p, and its mean over the runs scatters by what they differ by: the result is its
/// mean and covariance a posteriori (empirical Bayes: Efron & Morris 1973, J. Am. Stat. Assoc. 68, 117).
/// Nothing outside these directions, and in exact features. `drawn`: reduced covariance by which the
/// explanation's draws differ; empty: it does not draw.
AtFit at_fit(const std::string& id, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& drawn,
             const ReducedSpace& space);

/// That of an explanation; null where it was not run as it fits.
const AtFit* at_fit_of(const std::vector<AtFit>& all, const std::string& id);

}  // namespace pendular::diagnosis
