#pragma once

#include <string>

#include "base/sample.h"

namespace pendular::test {

/// A sample file that states everything: as sample A, but for what some sections say.
inline std::string sample_file(const std::string& sections) {
  return sample_text(parse_sample(sections, "test"));
}

}  // namespace pendular::test
