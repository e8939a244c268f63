#pragma once

#include <map>
#include <string>

namespace pendular {

/// Metres in a unit of length, by its symbol or name; 0 for any other word. Internal to volume.
inline double length_unit(const std::string& word) {
  static const std::map<std::string, double> known = {
      {"m", 1.0},           {"meter", 1.0},       {"metre", 1.0},       {"cm", 1e-2},
      {"centimeter", 1e-2}, {"centimetre", 1e-2}, {"mm", 1e-3},         {"millimeter", 1e-3},
      {"millimetre", 1e-3}, {"um", 1e-6},         {"\u00b5m", 1e-6},    {"\u03bcm", 1e-6},
      {"micron", 1e-6},     {"microns", 1e-6},    {"micrometer", 1e-6}, {"micrometre", 1e-6},
      {"nm", 1e-9},         {"nanometer", 1e-9},  {"nanometre", 1e-9}};
  const auto found = known.find(word);
  return found == known.end() ? 0.0 : found->second;
}

}  // namespace pendular
