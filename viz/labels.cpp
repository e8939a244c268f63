#include "viz/labels.h"

#include <algorithm>
#include <sstream>

namespace pendular::viz {
namespace {

constexpr double kCharacterWidth = 0.56;  // of Arial's size, mean of small letters, rounded up
constexpr const char* kEllipsis = "...";

bool starts_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
}

/// The first `count` characters.
std::string head(const std::string& text, std::size_t count) {
  std::size_t at = 0, seen = 0;
  for (; at < text.size(); ++at)
    if (starts_character(text[at]) && seen++ == count) break;
  return text.substr(0, at);
}

std::string tail(const std::string& text, std::size_t count) {
  return text.substr(head(text, characters(text) - count).size());
}

}  // namespace

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

std::string shortened(const std::string& text, std::size_t most) {
  const std::size_t length = characters(text), kept = most - std::min<std::size_t>(most, 3);
  if (length <= most) return text;
  return head(text, kept - kept / 2) + kEllipsis + tail(text, kept / 2);
}

std::string wrapped(const std::string& text, std::size_t most, std::size_t lines) {
  std::vector<std::string> done = {""};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    word = shortened(word, most);
    std::string& line = done.back();
    if (line.empty())
      line = word;
    else if (characters(line) + 1 + characters(word) <= most)
      line += ' ' + word;
    else
      done.push_back(word);
  }
  if (done.size() > lines) {
    done.resize(lines);
    std::string& last = done.back();
    while (characters(last) + 4 > most && last.find(' ') != std::string::npos) last.resize(last.rfind(' '));
    last = head(last, most - std::min<std::size_t>(most, 4)) + ' ' + kEllipsis;
  }
  std::string whole = done.front();
  for (std::size_t k = 1; k < done.size(); ++k) whole += '\n' + done[k];
  return whole;
}

double label_width(std::span<const std::string> labels, double size) {
  std::size_t longest = 0;
  for (const std::string& label : labels) {
    std::istringstream lines(label);
    for (std::string line; std::getline(lines, line);) longest = std::max(longest, characters(line));
  }
  return kCharacterWidth * size * static_cast<double>(longest);
}

}  // namespace pendular::viz
