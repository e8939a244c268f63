#include "base/text_line.h"

#include <cstddef>
#include <cstdint>

namespace pendular {
namespace {

constexpr std::size_t kHead = 400, kTail = 190;  // bytes that are kept of a line that is too long

bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

/// A character and its length in bytes; length 0 where the bytes are no UTF-8.
struct Character {
  std::uint32_t code = 0;
  std::size_t length = 0;
};

Character first_character(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (length == 0 || first > 0xf4 || text.size() < length) return {};
  std::uint32_t code = length == 1 ? first : first & (0xffU >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if (!continues(text[k])) return {};
    code = code << 6U | (static_cast<unsigned char>(text[k]) & 0x3fU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  if (overlong || surrogate || code > 0x10ffff) return {};
  return {code, length};
}

bool is_printable(std::uint32_t code) {
  const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
  const bool direction = (code >= 0x200e && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
                         (code >= 0x2066 && code <= 0x2069);
  return !control && !direction && code != 0xfeff && (code & 0xfffeU) != 0xfffeU;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const auto [code, length] = first_character(text);
    if (text[0] == '\n' || text[0] == '\r' || text[0] == '\t')
      line += ' ';
    else if (length > 0 && is_printable(code))
      line += text.substr(0, length);
    else
      line += '?';
    text.remove_prefix(length > 0 ? length : 1);
  }
  return line;
}

std::string text_line(std::string_view text) {
  std::string line = printable(text);
  if (line.size() <= kHead + kTail + 10) return line;
  std::size_t head = kHead, tail = line.size() - kTail;
  while (continues(line[head])) --head;
  while (continues(line[tail])) ++tail;
  return line.substr(0, head) + " \u2026 " + line.substr(tail);
}

}  // namespace pendular
