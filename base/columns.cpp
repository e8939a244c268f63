#include "base/columns.h"

#include <cmath>
#include <string_view>

#include "base/error.h"

namespace pendular {
namespace {

constexpr double kMetre = 1e6;  // µm

struct Rule {
  std::string_view name;
  Range range;
};

constexpr Rule kNames[] = {
    {"diameter_um", {1e-3, kMetre}}, {"bridge_diameter_um", {0.0, kMetre}},
    {"d_um", {0.0, kMetre}},         {"D_um", {0.0, kMetre}},
    {"probability", {0.0, 1.0}},     {"quality", {0.0, 1e3}},
    {"boundary", {0.0, 1.0}},        {"z", {0.0, 1e3}},
    {"z_sigma", {0.0, 1e3}},         {"count", {0.0, 1e12}},
    {"sigma", {0.0, 1e3}},
};

/// Longer units first.
constexpr Rule kUnits[] = {
    {"_n_per_m", {-1e12, 1e12}}, {"_um", {-kMetre, kMetre}}, {"_pa", {-1e13, 1e13}},
    {"_j", {-1e6, 1e6}},         {"_n", {-1e6, 1e6}},        {"_s", {-1e9, 1e9}},
};

Range signed_range_of(const std::string& column) {
  for (const auto& [unit, range] : kUnits)
    if (column.ends_with(unit)) return range;
  return {-1e15, 1e15};
}

}  // namespace

Range range_of(const std::string& column) {
  for (const auto& [name, range] : kNames)
    if (column == name) return range;
  Range range = signed_range_of(column);
  if (column.find("sigma") != std::string::npos) range.lowest = 0.0;
  return range;
}

void require_in_range(const std::string& where, const std::string& what, const Range& range, double value) {
  if (range.holds(value)) return;
  if (!std::isfinite(value)) bad_input("{}: {}: found {}, expected a finite number", where, what, value);
  bad_input("{}: {}: found {:.6g}, expected a number from {:.6g} to {:.6g} (wrong unit?)", where, what, value,
            range.lowest, range.highest);
}

}  // namespace pendular
