#pragma once

#include <string>
#include <vector>

namespace pendular::viz {

/// Round values (1, 2 or 5 times a power of ten apart) inside a range, at most about `wanted` of them, and
/// their labels, all with as many decimals as the step needs. Expects low < high.
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
};
Ticks round_ticks(double low, double high, int wanted);

}  // namespace pendular::viz
