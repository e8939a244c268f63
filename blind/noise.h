#pragma once

#include <cstdint>
#include <string>

#include "base/random.h"

namespace pendular::blind {

/// The noise of one instrument in one case: a function of the case's seed and the instrument's name,
/// independent of what is true.
class Noise {
 public:
  Noise(std::uint64_t seed, const std::string& instrument) : seed_(seed) {
    for (const char c : instrument) seed_ = random_bits(seed_, static_cast<unsigned char>(c));
  }
  double normal() { return random_normal(seed_, next_++); }
  double between(double low, double high) { return low + (high - low) * random_uniform(~seed_, next_++); }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  std::size_t below(std::size_t limit) {
    return static_cast<std::size_t>(between(0.0, static_cast<double>(limit)));
  }
  /// A stated standard deviation over the true one.
  double misjudged() { return between(0.7, 1.3); }

 private:
  std::uint64_t seed_, next_ = 0;
};

}  // namespace pendular::blind
