#include "diagnosis/kinds/features.h"

#include <cmath>

#include "diagnosis/kinds/kind.h"

namespace pendular::diagnosis {

std::string to_string(Scale scale) {
  static constexpr const char* kNames[] = {"bridge", "network", "aggregate"};
  return kNames[static_cast<int>(scale)];
}

double Feature::compared() const {
  return logarithm ? std::log(value) : value;
}

std::vector<Feature> features_of(Level level, const Observation& observation, const Columns& columns) {
  const Kind& kind = *observation.kind;
  if (level == Level::readings && kind.field && !observation.beads.empty()) return {};  // field_statistics.h
  return level == Level::readings && kind.readings ? kind.readings(observation, columns)
                                                   : kind.landmarks(observation, columns);
}

}  // namespace pendular::diagnosis
