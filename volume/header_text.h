#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "volume/voxel_header.h"

namespace pendular {

/// A line "key SEPARATOR value" of a header, without blanks around either. Internal to segmentation, as all
/// here.
struct HeaderField {
  std::string key, value;
};

/// The text part of a volume file. It ends after 1 MiB at the latest.
class HeaderText {
 public:
  explicit HeaderText(const fs::path& path);

  /// The next line without its end; false where the text ends.
  bool next(std::string& line);
  std::uint64_t position() const { return position_; }  ///< of the byte after the last line
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  std::string text_;
  std::size_t position_ = 0;
};

/// The fields of a header. Each message opens with file and field.
class HeaderFields {
 public:
  explicit HeaderFields(fs::path path) : path_(std::move(path)) {}

  void add(HeaderField field);  ///< BadInput for one that is there already
  bool has(std::string_view key) const { return find(key) != nullptr; }
  const std::string& text(std::string_view key) const;  ///< BadInput where it is missing
  std::string text(std::string_view key, const std::string& otherwise) const;
  std::string where(std::string_view key) const { return path_.string() + ": " + std::string(key); }

  std::int64_t integer(std::string_view key, std::int64_t lowest, std::int64_t highest) const;
  std::int64_t integer(std::string_view key, std::int64_t lowest, std::int64_t highest,
                       std::int64_t otherwise) const;
  std::vector<double> numbers(std::string_view key) const;  ///< finite, parted by blanks

 private:
  const std::string* find(std::string_view key) const;

  fs::path path_;
  std::vector<HeaderField> fields_;
};

std::string_view trimmed(std::string_view text);
std::vector<std::string> words_of(std::string_view text);
std::int64_t to_integer(const std::string& where, std::string_view word, std::int64_t lowest,
                        std::int64_t highest);
double to_number(const std::string& where, std::string_view word);  ///< finite

/// Sizes of a volume: three, and ones after them, whose product in bytes a file may have.
std::array<std::size_t, 3> volume_size(const HeaderFields& fields, std::string_view key,
                                       std::int64_t dimensions, std::size_t bytes_per_voxel);

/// Positive edges.
std::array<double, 3> edges_of(const std::string& where, const std::vector<double>& found);

/// A regular file, named from the folder of the header.
fs::path data_file(const std::string& where, const fs::path& header, const std::string& name);

/// Names that a pattern of one whole number (%d, %3d, %03d) gives from `first` to `last`, at most `most`.
std::vector<std::string> expanded(const std::string& where, const std::string& pattern, std::int64_t first,
                                  std::int64_t last, std::int64_t step, std::size_t most);

}  // namespace pendular
