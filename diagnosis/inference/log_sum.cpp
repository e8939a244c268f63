#include "diagnosis/inference/log_sum.h"

#include <algorithm>
#include <cmath>

namespace pendular::diagnosis {

double log_sum(std::span<const double> terms) {
  const double largest = *std::max_element(terms.begin(), terms.end());
  if (!std::isfinite(largest)) return largest;
  double sum = 0.0;
  for (double term : terms) sum += std::exp(term - largest);
  return largest + std::log(sum);
}

}  // namespace pendular::diagnosis
