#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace pendular::viz {

/// A specimen that a report's reader turns, cuts and asks: beads and the pairs between them at one moment or
/// several.
struct SpecimenView {
  enum class Colours { rising, alarm, signed_values };
  enum class Pair : std::uint8_t { bond, broken, contact, absent };

  /// A number for every bead, or for every pair, at every moment.
  struct Field {
    std::string name, unit;
    Colours colours = Colours::rising;
    double low = 0.0, high = 1.0;  ///< ends of the colours to begin with
  };

  struct Moment {
    std::string label;
    std::vector<Vec3> centres;                     ///< m
    std::vector<std::vector<double>> values;       ///< by field and bead; NaN: not known
    std::vector<Pair> states;                      ///< by pair
    std::vector<std::vector<double>> pair_values;  ///< by field of pairs and pair
  };

  std::string caption;
  std::vector<std::int64_t> ids;
  std::vector<double> diameters;  ///< m
  std::vector<Field> fields;      ///< at least one; the first is shown to begin with
  std::vector<std::array<int, 2>> pairs;
  std::vector<Field> pair_fields;
  std::vector<Moment> moments;  ///< at least one; the last is shown to begin with
};

/// Sets the ends of every field's colours from its values at the last moment, as the pictures do: the middle
/// 96 % of them, about zero where colours are signed.
void set_ranges(SpecimenView& view);

/// The view as a figure of an HTML page: its data, packed (positions in 16 bit of the specimen's extent,
/// other numbers in three digits), and one line for where it cannot be drawn. view_script() brings it to
/// life.
std::string to_html(const SpecimenView& view);

/// Script and style that every page with such a figure needs once.
const std::string& view_script();
const std::string& view_style();

}  // namespace pendular::viz
