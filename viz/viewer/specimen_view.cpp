#include "viz/viewer/specimen_view.h"

#include <fmt/format.h>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "viz/colours.h"
#include "viz/html_text.h"

namespace pendular::viz {
namespace {

using nlohmann::ordered_json;

constexpr double kMm = 1e3;
constexpr double kLargestHalf = 16384.0,
                 kNone = 65504.0;  // as halves; view.js takes what exceeds 60000 for none
constexpr int kColours = 65;

template <typename T>
std::string packed(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

ColourMap map_of(SpecimenView::Colours colours) {
  return colours == SpecimenView::Colours::rising  ? ColourMap::rising
         : colours == SpecimenView::Colours::alarm ? ColourMap::alarm
                                                   : ColourMap::signed_values;
}

std::string packed_colours(SpecimenView::Colours map) {
  const auto stops = colours_of(map_of(map));
  std::vector<std::uint8_t> bytes;
  for (int k = 0; k < kColours; ++k) {
    const double place = static_cast<double>(k) / (kColours - 1) * static_cast<double>(stops.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double share = place - static_cast<double>(low);
    for (std::size_t c = 0; c < 3; ++c)
      bytes.push_back(static_cast<std::uint8_t>(
          std::lround(255.0 * ((1.0 - share) * stops[low][c] + share * stops[low + 1][c]))));
  }
  return packed(bytes);
}

constexpr const char* name_of(SpecimenView::Colours colours) {
  return colours == SpecimenView::Colours::rising  ? "rising"
         : colours == SpecimenView::Colours::alarm ? "alarm"
                                                   : "signed";
}

/// A power of two that brings the largest of a field's values near the largest half.
double unit_of(const SpecimenView& view, std::size_t field,
               std::vector<std::vector<double>> SpecimenView::Moment::*of) {
  double largest = 0.0;
  for (const auto& moment : view.moments)
    for (const double v : (moment.*of)[field])
      if (std::isfinite(v)) largest = std::max(largest, std::fabs(v));
  return largest > 0.0 ? std::exp2(std::ceil(std::log2(largest / kLargestHalf))) : 1.0;
}

std::string halves(const std::vector<double>& values, double unit) {
  std::vector<std::uint16_t> bits;
  bits.reserve(values.size());
  for (const double v : values)
    bits.push_back(Eigen::half(static_cast<float>(std::isfinite(v) ? v / unit : kNone)).x);
  return packed(bits);
}

ordered_json fields_of(const std::vector<SpecimenView::Field>& fields, const std::vector<double>& units) {
  ordered_json out = ordered_json::array();
  for (std::size_t k = 0; k < fields.size(); ++k)
    out.push_back({{"name", fields[k].name},
                   {"unit", fields[k].unit},
                   {"map", name_of(fields[k].colours)},
                   {"low", fields[k].low},
                   {"high", fields[k].high},
                   {"unit_of_value", units[k]}});
  return out;
}

/// The box that holds every centre, mm; nowhere flat.
Eigen::AlignedBox3d extent_of(const SpecimenView& view) {
  Eigen::AlignedBox3d box;
  for (const auto& moment : view.moments)
    for (const Vec3& p : moment.centres) box.extend(kMm * p);
  const Vec3 least = Vec3::Constant(1e-6);
  return {box.min() - least, box.max() + least};
}

std::string packed_centres(const std::vector<Vec3>& centres, const Eigen::AlignedBox3d& box) {
  std::vector<std::uint16_t> out;
  out.reserve(3 * centres.size());
  for (const Vec3& p : centres)
    for (int axis = 0; axis < 3; ++axis)
      out.push_back(static_cast<std::uint16_t>(
          std::lround(65535.0 * (kMm * p[axis] - box.min()[axis]) / box.sizes()[axis])));
  return packed(out);
}

ordered_json data_of(const SpecimenView& view) {
  const auto box = extent_of(view);
  std::vector<double> units, pair_units;
  for (std::size_t k = 0; k < view.fields.size(); ++k)
    units.push_back(unit_of(view, k, &SpecimenView::Moment::values));
  for (std::size_t k = 0; k < view.pair_fields.size(); ++k)
    pair_units.push_back(unit_of(view, k, &SpecimenView::Moment::pair_values));
  std::vector<float> diameters;
  for (const double d : view.diameters) diameters.push_back(static_cast<float>(kMm * d));
  std::vector<std::uint32_t> ends;
  for (const auto& pair : view.pairs)
    for (const int end : pair) ends.push_back(static_cast<std::uint32_t>(end));
  ordered_json data{{"ids", view.ids},
                    {"diameters", packed(diameters)},
                    {"low", {box.min().x(), box.min().y(), box.min().z()}},
                    {"size", {box.sizes().x(), box.sizes().y(), box.sizes().z()}},
                    {"pairs", packed(ends)},
                    {"fields", fields_of(view.fields, units)},
                    {"pair_fields", fields_of(view.pair_fields, pair_units)}};
  for (const auto map :
       {SpecimenView::Colours::rising, SpecimenView::Colours::alarm, SpecimenView::Colours::signed_values})
    data["maps"][name_of(map)] = packed_colours(map);
  data["moments"] = ordered_json::array();
  for (const auto& moment : view.moments) {
    ordered_json values = ordered_json::array(), pair_values = ordered_json::array();
    for (std::size_t k = 0; k < units.size(); ++k) values.push_back(halves(moment.values[k], units[k]));
    for (std::size_t k = 0; k < pair_units.size(); ++k)
      pair_values.push_back(halves(moment.pair_values[k], pair_units[k]));
    data["moments"].push_back({{"label", moment.label},
                               {"centres", packed_centres(moment.centres, box)},
                               {"values", values},
                               {"states", packed(moment.states)},
                               {"pair_values", pair_values}});
  }
  return data;
}

/// As it may stand within a script element, which ends at the next "</script".
std::string in_script(const ordered_json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, ordered_json::error_handler_t::replace))
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

void set_range(SpecimenView::Field& field, const std::vector<double>& values) {
  const Range range = robust_range(values);
  field.low = range.low, field.high = range.high;
  if (field.colours == SpecimenView::Colours::signed_values) {
    field.high = std::max(std::fabs(range.low), std::fabs(range.high));
    field.low = -field.high;
  }
}

}  // namespace

void set_ranges(SpecimenView& view) {
  const auto& last = view.moments.back();
  for (std::size_t k = 0; k < view.fields.size(); ++k) set_range(view.fields[k], last.values[k]);
  for (std::size_t k = 0; k < view.pair_fields.size(); ++k)
    set_range(view.pair_fields[k], last.pair_values[k]);
}

std::string to_html(const SpecimenView& view) {
  return fmt::format(
      "<figure class=\"specimen\"><canvas class=\"stage\" tabindex=\"0\" role=\"img\" aria-label=\"{0}\">"
      "</canvas><div class=\"controls\"></div><p class=\"note\">The specimen cannot be turned here (no "
      "script runs); the pictures remain.</p><figcaption>{0} Drag to turn, shift-drag to move, wheel to "
      "zoom; "
      "click a bead for its numbers.</figcaption><script type=\"application/json\">{1}</script></figure>\n",
      escaped(view.caption), in_script(data_of(view)));
}

}  // namespace pendular::viz
