#pragma once

// For readers of TOML files: where a value stands, and values as their keys want them. Only for .cpp files of
// folders that link the TOML library.

#include <toml++/toml.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/path_kind.h"
#include "base/sample.h"
#include "base/text_line.h"

namespace pendular {

struct TomlPlace {
  std::string file;
  std::string name;  ///< of the key
  const toml::node& node;

  /// "file:line: key", for the head of a message.
  std::string str() const { return fmt::format("{}:{}: {}", file, node.source().begin.line, name); }
};

/// The file as a table; BadInput naming file and line for what is no TOML.
inline toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    bad_input("{}:{}: {}", file, error.source().begin.line, printable(error.description()));
  }
}

inline std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a string";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::table:
      return "a table";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return node.is_number() ? "a number" : "another type";
  }
}

/// The nearest double of a number; the library has none for an integer that is between two of them.
inline double nearest_double(const toml::node& number) {
  const auto* integer = number.as_integer();
  return integer ? static_cast<double>(integer->get()) : number.as_floating_point()->get();
}

inline double number_at(const TomlPlace& place) {
  if (!place.node.is_number())
    bad_input("{}: found {}, expected a number", place.str(), type_name(place.node));
  const double value = nearest_double(place.node);
  if (!std::isfinite(value)) bad_input("{}: found {}, expected a finite number", place.str(), value);
  return value;
}

inline std::string word_at(const TomlPlace& place) {
  const auto* word = place.node.as_string();
  if (!word) bad_input("{}: found {}, expected a string", place.str(), type_name(place.node));
  return word->get();
}

/// A file that is there, named from the folder of the file that names it.
inline fs::path file_at(const TomlPlace& place) {
  const std::string given = word_at(place);
  fs::path path = fs::path(place.file).parent_path() / given;
  if (given.empty() || !is_file(path))
    bad_input("{}: found \"{}\", expected a file; {} is none", place.str(), given, path.string());
  return path;
}

/// A value of a sample's key, of any kind that there is.
inline SampleValue value_at(const TomlPlace& place) {
  if (place.node.is_number()) return number_at(place);
  if (const auto* truth = place.node.as_boolean()) return truth->get();
  if (const auto* word = place.node.as_string()) return word->get();
  const auto* array = place.node.as_array();
  if (!array)
    bad_input("{}: found {}, expected a number, a word, true or false, or an array", place.str(),
              type_name(place.node));
  std::vector<double> numbers;
  for (const auto& item : *array) numbers.push_back(number_at({place.file, place.name, item}));
  return numbers;
}

}  // namespace pendular
