#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/files.h"

namespace pendular {

/// A line of a text file, split at white space; what follows a `#` is its comment. Internal to packing.
struct WordLine {
  std::string where;  ///< "file:line"
  std::vector<std::string> words;
  std::string comment;

  double number(std::size_t word) const;  ///< finite; BadInput naming the line otherwise
  std::int64_t integer(std::size_t word) const;
  void require(std::size_t words,
               const char* expected) const;  ///< BadInput unless there are that many or more
};

/// The lines from `first` (counted from 1) on that hold more than a comment.
std::vector<WordLine> read_word_lines(const fs::path& path, std::size_t first = 1);

}  // namespace pendular
