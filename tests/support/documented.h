#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/files.h"
#include "places.h"

// Reads what docs/formats.md says: of the table under a heading, the names in backticks in its first column.

namespace pendular::test {

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The names in backticks of a text.
inline std::vector<std::string> names_in_backticks(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = text.find('`'); at != std::string::npos; at = text.find('`', at)) {
    const auto end = text.find('`', at + 1);
    if (end == std::string::npos) break;
    names.push_back(text.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return names;
}

inline std::string formats_page() {
  return read_text(fs::path(source_folder()) / "docs" / "formats.md");
}

/// Names of the first column of the table under "### heading", in its order.
inline std::vector<std::string> documented(const std::string& heading) {
  std::vector<std::string> names;
  bool inside = false, found = false;
  for (const auto& line : lines_of(formats_page())) {
    if (line.rfind('#', 0) == 0) inside = line == "### " + heading, found = found || inside;
    if (!inside || line.rfind("| `", 0) != 0) continue;
    const auto cell = names_in_backticks(line.substr(0, line.find('|', 1)));
    names.insert(names.end(), cell.begin(), cell.end());
  }
  EXPECT_TRUE(found) << "docs/formats.md has no heading \"### " << heading << "\"";
  return names;
}

/// Names of each row of that table, all columns of the row together.
inline std::vector<std::vector<std::string>> documented_rows(const std::string& heading) {
  std::vector<std::vector<std::string>> rows;
  bool inside = false;
  for (const auto& line : lines_of(formats_page())) {
    if (line.rfind('#', 0) == 0) inside = line == "### " + heading;
    if (inside && line.rfind("| `", 0) == 0) rows.push_back(names_in_backticks(line));
  }
  EXPECT_FALSE(rows.empty()) << "docs/formats.md has no table under \"### " << heading << "\"";
  return rows;
}

/// The columns of a CSV file, in its order.
inline std::vector<std::string> columns_of(const fs::path& path) {
  for (const auto& line : lines_of(read_text(path))) {
    if (line.rfind('#', 0) == 0) continue;
    std::vector<std::string> columns;
    std::istringstream in(line);
    for (std::string column; std::getline(in, column, ',');) columns.push_back(column);
    return columns;
  }
  ADD_FAILURE() << path << " has no header line";
  return {};
}

inline void add_keys(const nlohmann::json& json, const std::string& prefix, std::set<std::string>& keys) {
  for (const auto& [key, value] : json.items())
    if (value.is_object())
      add_keys(value, prefix + key + ".", keys);
    else
      keys.insert(prefix + key);
}

/// Whether a documented name stands for a key: itself, "name.*", or what a name without parts holds.
inline bool stands_for(const std::string& name, const std::string& key) {
  const std::string stem = name.size() > 2 && name.ends_with(".*") ? name.substr(0, name.size() - 2) : name;
  return key == stem || key.rfind(stem + ".", 0) == 0;
}

/// Every key of a JSON file is documented under a heading.
inline void expect_documented_keys(const fs::path& path, const std::string& heading) {
  const auto names = documented(heading);
  std::set<std::string> keys;
  add_keys(nlohmann::json::parse(read_text(path)), "", keys);
  EXPECT_GT(keys.size(), 3u) << path;
  for (const auto& key : keys)
    EXPECT_TRUE(
        std::any_of(names.begin(), names.end(), [&](const auto& name) { return stands_for(name, key); }))
        << path << " has the key " << key << ", which docs/formats.md does not name under " << heading;
}

}  // namespace pendular::test
