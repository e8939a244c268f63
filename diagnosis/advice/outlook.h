#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/inference/calibration.h"

namespace pendular::diagnosis {

/// What a diagnosis is expected to come to.
struct Outlook {
  std::size_t cases = 0;  ///< replayed runs behind it; 0: too few, nothing is expected
  double set_size = 0.0;  ///< mean
  double entropy = 0.0;   ///< of the probabilities, bits, mean
  double settled = 0.0;   ///< probability that the set is the truth alone
  std::map<std::string, EffectReplay> effects = {};  ///< runs of each that are told from none, and first
};

/// Mean over replayed runs of one effect or none, weighted; what sets hold is learnt from all of them alike
/// (promise_of()).
Outlook outlook_of(const std::vector<Replayed>& replayed, double confidence,
                   const std::function<double(const Replayed&)>& weight);

/// The same runs, diagnosed by one who knows of some effects whether they are there.
std::vector<Replayed> knowing(std::vector<Replayed> replayed, const std::set<std::string>& effects);

}  // namespace pendular::diagnosis
