#pragma once

#include <string>
#include <vector>

namespace pendular {

/// A key of the sample file as docs/sample.md tells it.
struct SampleReference {
  std::string name;     ///< dotted
  std::string values;   ///< that it takes: a range, words, strains
  std::string absent;   ///< its value where a file leaves it out; "required"
  std::string meaning;  ///< one line
};

/// Every key but those of [effects], section by section in the order of the file.
std::vector<SampleReference> sample_reference();

}  // namespace pendular
