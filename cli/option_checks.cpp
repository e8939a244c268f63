#include "cli/option_checks.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>

namespace pendular::cli {

CLI::Validator within(double lowest, double highest) {
  const std::string range = fmt::format("{} to {}", lowest, highest);
  return CLI::Validator(
      [=](std::string& word) {
        double value = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        const bool number = error == std::errc() && end == word.data() + word.size();
        return number && value >= lowest && value <= highest
                   ? std::string()
                   : fmt::format("found {}, expected a number from {}", word, range);
      },
      "in " + range);
}

CLI::Validator whole_number() {
  return CLI::Validator(
      [](std::string& word) {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        const bool whole = error == std::errc() && end == word.data() + word.size();
        return whole ? std::string() : fmt::format("found {}, expected a whole number below 2^64", word);
      },
      "");
}

}  // namespace pendular::cli
