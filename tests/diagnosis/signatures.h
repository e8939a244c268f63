#pragma once

#include "diagnosis/bank/signature.h"

namespace pendular::diagnosis::test {

/// A response that is a line in θ.
inline Signature signature(const std::string& id, const Eigen::VectorXd& slope, double lowest, double highest,
                           double scale, double least = 0.0) {
  Signature signature;
  signature.id = id;
  signature.powers = {slope};
  signature.lowest = lowest, signature.highest = highest, signature.scale = scale, signature.least = least;
  return signature;
}

}  // namespace pendular::diagnosis::test
