#pragma once

#include <CLI/CLI.hpp>

namespace pendular::cli {

/// For an option's check(): a number from `lowest` to `highest`, which NaN is not; a whole number that 64
/// bits hold.
CLI::Validator within(double lowest, double highest);
CLI::Validator whole_number();

}  // namespace pendular::cli
