#pragma once

#include <string>
#include <vector>

#include "base/sample.h"

namespace pendular::diagnosis {

/// A point of the bond's law that the paper leaves open. Which way a specimen follows is not known: what the
/// other way does enters as a believed input.
struct LawReading {
  const char* id;
  const char* name;               ///< for readers
  void (*other)(Sample& sample);  ///< takes the other way
};

/// By as much as engines differ: docs/engines.md.
const std::vector<LawReading>& law_readings();

/// The other way of a reading, as a sample states it: `contact.glass = "hertz"`.
std::string other_setting(const LawReading& reading, const Sample& sample);

/// The reading of that id, or of that name for readers; nullptr where there is none.
const LawReading* find_law_reading(const std::string& id);
const LawReading* law_reading_named(const std::string& name);

}  // namespace pendular::diagnosis
