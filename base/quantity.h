#pragma once

#include <string>
#include <utility>

namespace pendular {

/// A number with three significant digits, whole from 100 on; empty where it is not finite.
std::string rounded(double value);

/// A share in per cent without decimals and without the sign; "<1" and ">99" where it is not all or nothing.
std::string per_cent(double share);

/// The same with the sign: "97 %".
std::string percent(double share);

/// A unit as a reader expects it, and what numbers in the unit that a table has are multiplied with for it.
struct SpeltUnit {
  std::string after;  ///< a number, its space included
  double factor = 1.0;
  bool word = false;  ///< told once, after an interval: "1.2 (0.9 to 1.5) times"
};

/// Units are those of the library of effects and of tables: um is spelt µm, degrees are °; fractions and
/// strains are told in %, pascals in kPa, MPa or GPa as the `largest` number asks for; of "1" nothing is
/// said. Other units stay as they are.
SpeltUnit spelt_unit(const std::string& unit, double largest);

/// A quantity in words, with three significant digits, "4.07 µm".
std::string quantity(double value, const std::string& unit);

/// With its interval, "20 % (18 to 21 %)": as many decimals as a third of the interval's width has, none
/// where that is one or more.
std::string quantity(double value, const std::pair<double, double>& interval, const std::string& unit);

/// With as many decimals as the interval of three standard deviations would have.
std::string quantity_within(double value, double sigma, const std::string& unit);

/// The interval alone, "18 to 21 %".
std::string quantity(const std::pair<double, double>& interval, const std::string& unit);

}  // namespace pendular
