#include "base/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pendular {
namespace {

constexpr int kMostDecimals = 6;

int decimals_of(double width) {
  if (!(width > 0.0) || !std::isfinite(width)) return kMostDecimals;
  return std::clamp(-static_cast<int>(std::floor(std::log10(width / 3.0))), 0, kMostDecimals);
}

/// Without a minus sign before what rounds to zero.
std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "?";
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return zero && text.front() == '-' ? text.substr(1) : text;
}

double largest_of(const std::pair<double, double>& interval) {
  return std::max(std::fabs(interval.first), std::fabs(interval.second));
}

std::string interval_text(const std::pair<double, double>& interval, const SpeltUnit& spelling) {
  const double low = spelling.factor * interval.first, high = spelling.factor * interval.second;
  const int decimals = decimals_of(high - low);
  return fmt::format("{} to {}{}", fixed(low, decimals), fixed(high, decimals), spelling.after);
}

}  // namespace

SpeltUnit spelt_unit(const std::string& unit, double largest) {
  if (unit == "fraction" || unit == "strain") return {" %", 100.0};
  if (unit == "1" || unit.empty()) return {""};
  if (unit == "um") return {" µm"};
  if (unit == "um2") return {" µm²"};
  if (unit == "um/N") return {" µm/N"};
  if (unit == "degrees") return {"°"};
  if (unit == "multiple" || unit == "ratio") return {" times", 1.0, true};
  if (unit == "per strain") return {" per unit strain", 1.0, true};
  if (unit == "Pa") {
    if (largest >= 1e9) return {" GPa", 1e-9};
    if (largest >= 1e6) return {" MPa", 1e-6};
    if (largest >= 1e3) return {" kPa", 1e-3};
  }
  return {" " + unit};
}

std::string rounded(double value) {
  if (!std::isfinite(value)) return "";
  // Whole numbers of up to six digits as they are: 1200 is easier read than 1.2e+03.
  if (std::fabs(value) >= 100.0 && std::fabs(value) < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string per_cent(double share) {
  if (share > 0.0 && share < 0.005) return "<1";
  if (share < 1.0 && share >= 0.995) return ">99";
  return fmt::format("{:.0f}", 100.0 * share);
}

std::string percent(double share) {
  return per_cent(share) + " %";
}

std::string quantity(double value, const std::string& unit) {
  const SpeltUnit spelling = spelt_unit(unit, std::fabs(value));
  const std::string number = rounded(spelling.factor * value);
  return number.empty() ? "" : number + spelling.after;
}

std::string quantity(double value, const std::pair<double, double>& interval, const std::string& unit) {
  const double width = interval.second - interval.first;
  if (!(width > 0.0) || !std::isfinite(width)) return quantity(value, unit);
  const SpeltUnit spelling = spelt_unit(unit, std::max(std::fabs(value), largest_of(interval)));
  const std::string number = fixed(spelling.factor * value, decimals_of(spelling.factor * width));
  if (!spelling.word)
    return fmt::format("{}{} ({})", number, spelling.after, interval_text(interval, spelling));
  return fmt::format("{} ({}){}", number, interval_text(interval, {"", spelling.factor}), spelling.after);
}

std::string quantity_within(double value, double sigma, const std::string& unit) {
  if (!std::isfinite(value) || !(sigma > 0.0)) return quantity(value, unit);
  const SpeltUnit spelling = spelt_unit(unit, std::fabs(value));
  return fixed(spelling.factor * value, decimals_of(3.0 * spelling.factor * sigma)) + spelling.after;
}

std::string quantity(const std::pair<double, double>& interval, const std::string& unit) {
  return interval_text(interval, spelt_unit(unit, largest_of(interval)));
}

}  // namespace pendular
