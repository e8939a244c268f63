#include "packing/word_lines.h"

#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>

#include "base/error.h"

namespace pendular {
namespace {

template <typename T>
T parse(const WordLine& line, std::size_t word, const char* expected) {
  const std::string& text = line.words.at(word);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    bad_input("{}: word {}: found \"{}\", expected {}", line.where, word + 1, text, expected);
  return value;
}

}  // namespace

double WordLine::number(std::size_t word) const {
  const auto value = parse<double>(*this, word, "a number");
  if (!std::isfinite(value))
    bad_input("{}: word {}: found {}, expected a finite number", where, word + 1, words[word]);
  return value;
}

std::int64_t WordLine::integer(std::size_t word) const {
  return parse<std::int64_t>(*this, word, "an integer");
}

void WordLine::require(std::size_t count, const char* expected) const {
  if (words.size() < count) bad_input("{}: found {} words, expected {}", where, words.size(), expected);
}

std::vector<WordLine> read_word_lines(const fs::path& path, std::size_t first) {
  std::istringstream in(read_text(path));
  std::vector<WordLine> lines;
  std::size_t number = 0;
  for (std::string text; std::getline(in, text);) {
    if (++number < first) continue;
    WordLine line{fmt::format("{}:{}", path.string(), number), {}, {}};
    const std::size_t mark = text.find('#');
    if (mark != std::string::npos) line.comment = text.substr(mark + 1);
    std::istringstream words(text.substr(0, mark));
    line.words.assign(std::istream_iterator<std::string>(words), {});
    if (!line.words.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace pendular
