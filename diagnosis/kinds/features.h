#pragma once

#include <string>
#include <vector>

#include "diagnosis/experiment/observation.h"

namespace pendular::diagnosis {

/// The ladder from one bridge to the whole.
enum class Scale { bridge, network, aggregate };

std::string to_string(Scale scale);

/// One number in which observation and simulation are compared.
struct Feature {
  std::string observation, name;
  Scale scale = Scale::aggregate;
  bool logarithm = false;  ///< compared by ratio; else by difference
  double value = 0.0;
  double strain_from = 0.0, strain_to = 0.0;  ///< where it is read from, platen strain; 0, 0: no strain in it

  /// As it is compared: its logarithm or itself.
  double compared() const;
};

/// Two ways to read columns: landmarks are for words and for what a reader looks at; readings are all that
/// the columns say, from which explanations are weighed.
enum class Level { landmarks, readings };

/// What columns of an observation's kind come to: measured ones, or ones that a simulation gives in their
/// place. The observation tells where to look. Features that the columns do not show are left out.
std::vector<Feature> features_of(Level level, const Observation& observation, const Columns& columns);

}  // namespace pendular::diagnosis
