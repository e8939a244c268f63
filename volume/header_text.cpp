#include "volume/header_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"

namespace pendular {
namespace {

constexpr std::size_t kLongestHeader = 1 << 20;
constexpr std::int64_t kMostVoxels = std::int64_t{1} << 40;  // along an axis
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 60;
constexpr std::string_view kBlanks = " \t\r\v\f";

}  // namespace

HeaderText::HeaderText(const fs::path& path) : path_(path) {
  require_readable(path);
  text_.resize(std::min<std::uintmax_t>(kLongestHeader, fs::file_size(path)));
  std::ifstream in(path, std::ios::binary);
  in.read(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
}

bool HeaderText::next(std::string& line) {
  if (position_ >= text_.size()) return false;
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  line = text_.substr(position_, end - position_);
  position_ = std::min(end + 1, text_.size());
  return true;
}

void HeaderFields::add(HeaderField field) {
  if (has(field.key)) bad_input("{}: found twice, expected once", where(field.key));
  fields_.push_back(std::move(field));
}

const std::string* HeaderFields::find(std::string_view key) const {
  for (const auto& field : fields_)
    if (field.key == key) return &field.value;
  return nullptr;
}

const std::string& HeaderFields::text(std::string_view key) const {
  const std::string* found = find(key);
  if (found == nullptr) bad_input("{}: found no such field, expected a whole header", where(key));
  return *found;
}

std::string HeaderFields::text(std::string_view key, const std::string& otherwise) const {
  const std::string* found = find(key);
  return found == nullptr ? otherwise : *found;
}

std::int64_t HeaderFields::integer(std::string_view key, std::int64_t lowest, std::int64_t highest) const {
  return to_integer(where(key), text(key), lowest, highest);
}

std::int64_t HeaderFields::integer(std::string_view key, std::int64_t lowest, std::int64_t highest,
                                   std::int64_t otherwise) const {
  return has(key) ? integer(key, lowest, highest) : otherwise;
}

std::vector<double> HeaderFields::numbers(std::string_view key) const {
  std::vector<double> values;
  for (const auto& word : words_of(text(key))) values.push_back(to_number(where(key), word));
  return values;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (text = trimmed(text); !text.empty();) {
    const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
    words.emplace_back(text.substr(0, end));
    text = trimmed(text.substr(end));
  }
  return words;
}

std::int64_t to_integer(const std::string& where, std::string_view word, std::int64_t lowest,
                        std::int64_t highest) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value < lowest || value > highest)
    bad_input("{}: found \"{}\", expected a whole number from {} to {}", where, word, lowest, highest);
  return value;
}

double to_number(const std::string& where, std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    bad_input("{}: found \"{}\", expected a finite number", where, word);
  return value;
}

std::array<std::size_t, 3> volume_size(const HeaderFields& fields, std::string_view key,
                                       std::int64_t dimensions, std::size_t bytes_per_voxel) {
  const std::string where = fields.where(key);
  const auto words = words_of(fields.text(key));
  if (static_cast<std::int64_t>(words.size()) != dimensions)
    bad_input("{}: found {} sizes, expected {}", where, words.size(), dimensions);
  std::array<std::size_t, 3> size{};
  std::uint64_t bytes = bytes_per_voxel;
  for (std::size_t axis = 0; axis < words.size(); ++axis) {
    const auto n = static_cast<std::uint64_t>(to_integer(where, words[axis], 1, kMostVoxels));
    if (axis >= 3 && n != 1) bad_input("{}: found an image of {} dimensions, expected 3", where, dimensions);
    if (n > kMostBytes / bytes)
      bad_input("{}: found \"{}\", expected a product that a file may hold", where, fields.text(key));
    bytes *= n;
    if (axis < 3) size[axis] = n;
  }
  return size;
}

std::array<double, 3> edges_of(const std::string& where, const std::vector<double>& found) {
  std::array<double, 3> edges{};
  if (found.size() < 3) bad_input("{}: found {} numbers, expected 3", where, found.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    edges[axis] = found[axis];
    if (!(edges[axis] > 0.0))
      bad_input("{}: found {}, expected a positive edge of a voxel", where, edges[axis]);
  }
  return edges;
}

fs::path data_file(const std::string& where, const fs::path& header, const std::string& name) {
  fs::path file = header.parent_path() / name;
  std::error_code error;
  if (name.empty() || name.find('\0') != std::string::npos || !fs::is_regular_file(file, error))
    bad_input("{}: found no file '{}', expected the voxels there", where, file.string());
  require_readable(file);
  return file;
}

std::vector<std::string> expanded(const std::string& where, const std::string& pattern, std::int64_t first,
                                  std::int64_t last, std::int64_t step, std::size_t most) {
  const std::size_t mark = pattern.find('%');
  std::size_t digits = mark + 1;
  while (digits < pattern.size() && pattern[digits] >= '0' && pattern[digits] <= '9') ++digits;
  const std::string width_text = mark == std::string::npos ? "" : pattern.substr(mark + 1, digits - mark - 1);
  if (mark == std::string::npos || width_text.size() > 2 || digits >= pattern.size() ||
      pattern[digits] != 'd' || pattern.find('%', digits) != std::string::npos)
    bad_input("{}: found \"{}\", expected a name with one number, as %d, %3d or %03d", where, pattern);
  const bool zeros = width_text.starts_with('0');
  const std::size_t width = width_text.empty() ? 0 : static_cast<std::size_t>(std::stoi(width_text));
  const std::uint64_t span =
      step > 0 ? static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first) : 0;
  if (step < 1 || last < first || span / static_cast<std::uint64_t>(step) >= most)
    bad_input("{}: found files from {} to {} by {}, expected {} slices", where, first, last, step, most);
  std::vector<std::string> names;
  for (std::uint64_t k = 0; k <= span / static_cast<std::uint64_t>(step); ++k) {
    std::string number = std::to_string(first + static_cast<std::int64_t>(k) * step);
    if (number.size() < width) number.insert(0, width - number.size(), zeros ? '0' : ' ');
    names.push_back(pattern.substr(0, mark) + number + pattern.substr(digits + 1));
  }
  return names;
}

}  // namespace pendular
