#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>

#include "base/error.h"
#include "base/inflate.h"
#include "packing/polydata_xml.h"

namespace pendular {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t kLongestText = 1U << 26;  // of a field

template <typename T>
struct Tag {
  using Type = T;
};

/// Calls f with the type of the array's numbers.
template <typename Function>
auto with_type(const XmlArray& array, const fs::path& path, const Function& f) {
  if (array.type == "Int8" || array.type == "String") return f(Tag<std::int8_t>());
  if (array.type == "UInt8") return f(Tag<std::uint8_t>());
  if (array.type == "Int16") return f(Tag<std::int16_t>());
  if (array.type == "UInt16") return f(Tag<std::uint16_t>());
  if (array.type == "Int32") return f(Tag<std::int32_t>());
  if (array.type == "UInt32") return f(Tag<std::uint32_t>());
  if (array.type == "Int64") return f(Tag<std::int64_t>());
  if (array.type == "UInt64") return f(Tag<std::uint64_t>());
  if (array.type == "Float32") return f(Tag<float>());
  if (array.type == "Float64") return f(Tag<double>());
  bad_input("{}: array {}: found type \"{}\", expected Int8 to UInt64, Float32 or Float64", path.string(),
            array.name, array.type);
}

constexpr std::uint32_t kNoDigit = 64;

/// What a character of base64 stands for; padding counts as 0.
constexpr std::array<std::uint32_t, 256> kDigits = [] {
  std::array<std::uint32_t, 256> digits{};
  digits.fill(kNoDigit);
  std::uint32_t next = 0;
  for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"))
    digits[static_cast<unsigned char>(c)] = next++;
  digits['='] = 0;
  return digits;
}();

/// The bytes behind an array's data, encoded as base64 or as they are.
class Stored {
 public:
  Stored(const PolyXml& xml, const XmlArray& array, const fs::path& path)
      : where_(path.string() + ": array " + array.name),
        raw_(array.format == XmlArray::Format::appended && xml.raw_appended),
        text_(array.format == XmlArray::Format::appended ? xml.appended : std::string_view(array.text)) {
    if (array.format == XmlArray::Format::appended) {
      if (array.offset > text_.size()) damaged("its offset is beyond the data");
      text_.remove_prefix(array.offset);
    } else {
      text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
    }
  }

  [[noreturn]] void damaged(const char* why) const {
    bad_input("{}: found damaged VTK data ({}), expected a readable .vtp", where_, why);
  }

  /// The first `count` bytes; with `take`, the next call starts after them and their padding.
  std::string bytes(std::uint64_t count, bool take) {
    const std::uint64_t size = raw_ ? count : (count + 2) / 3 * 4;
    if (count > text_.size() || size > text_.size()) damaged("it is cut short");
    const std::string_view part = text_.substr(0, size);
    if (take) text_.remove_prefix(size);
    return raw_ ? std::string(part) : decoded(part, count);
  }

  std::uint64_t size() const { return text_.size(); }

 private:
  std::string decoded(std::string_view text, std::uint64_t count) const {
    std::string out(text.size() / 4 * 3, '\0');
    std::uint32_t all = 0;
    for (std::size_t k = 0; k < text.size() / 4; ++k) {
      const auto digit = [&](std::size_t n) { return kDigits[static_cast<unsigned char>(text[4 * k + n])]; };
      all |= digit(0) | digit(1) | digit(2) | digit(3);
      const std::uint32_t bits = digit(0) << 18U | digit(1) << 12U | digit(2) << 6U | digit(3);
      for (std::size_t n = 0; n < 3; ++n) out[3 * k + n] = static_cast<char>(bits >> (16 - 8 * n));
    }
    if (all >= kNoDigit) damaged("it is no base64");
    out.resize(count);
    return out;
  }

  std::string where_;
  bool raw_;
  std::string_view text_;
};

template <typename T>
void swap_bytes(std::span<T> values) {
  for (T& value : values) {
    auto* first = reinterpret_cast<unsigned char*>(&value);
    std::reverse(first, first + sizeof(T));
  }
}

/// The numbers that head an array's data.
std::vector<std::uint64_t> heads_in(const std::string& bytes, bool wide, bool big_endian) {
  const auto read = [&](auto example) {
    std::vector<decltype(example)> values(bytes.size() / sizeof(example));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(example));
    if (big_endian) swap_bytes(std::span(values));
    return std::vector<std::uint64_t>(values.begin(), values.end());
  };
  return wide ? read(std::uint64_t{}) : read(std::uint32_t{});
}

/// Blocks: their number, the size of one, that of the last where it is another, and how many bytes each
/// takes.
std::string inflated(Stored stored, bool wide, bool big_endian, std::uint64_t most) {
  const std::uint64_t width = wide ? 8 : 4;
  const auto heads = [&](std::uint64_t count, bool take) {
    return heads_in(stored.bytes(count * width, take), wide, big_endian);
  };
  const std::uint64_t blocks = heads(1, false)[0];
  if (blocks == 0) return {};
  if (blocks > stored.size() / width) stored.damaged("more blocks than there are data");
  const auto head = heads(3 + blocks, true);
  const std::uint64_t block = head[1], last = head[2] == 0 ? block : head[2];
  if (block == 0 || last > block || last > most || blocks - 1 > (most - last) / block)
    stored.damaged("another size than it must have");
  std::uint64_t deflated = 0;
  for (std::uint64_t k = 0; k < blocks; ++k) {
    if (head[3 + k] > stored.size()) stored.damaged("it is cut short");
    deflated += head[3 + k];
  }
  const std::string all = stored.bytes(deflated, true);
  if ((blocks - 1) * block + last > kDeflateLimit * deflated)
    stored.damaged("another size than it must have");
  std::string out((blocks - 1) * block + last, '\0');
  std::uint64_t from = 0;
  for (std::uint64_t k = 0; k < blocks; ++k) {
    const std::uint64_t size = k + 1 < blocks ? block : last;
    const auto part = std::as_bytes(std::span(all)).subspan(from, head[3 + k]);
    if (inflate_into(part, std::as_writable_bytes(std::span(out)).subspan(k * block, size)) != size)
      stored.damaged("a block does not inflate to its size");
    from += head[3 + k];
  }
  return out;
}

/// The bytes of an array that is not in decimal numbers, no more than `most`.
std::string content(const PolyXml& xml, const XmlArray& array, std::uint64_t most, const fs::path& path) {
  Stored stored(xml, array, path);
  if (xml.deflated) return inflated(std::move(stored), xml.wide_heads, xml.big_endian, most);
  const std::uint64_t width = xml.wide_heads ? 8 : 4;
  const std::uint64_t size = heads_in(stored.bytes(width, false), xml.wide_heads, xml.big_endian)[0];
  if (size > most) stored.damaged("another size than it must have");
  return stored.bytes(width + size, true).substr(width);
}

/// Decimal numbers between white space.
template <typename T>
std::vector<T> parsed(const XmlArray& array, std::uint64_t most, const fs::path& path) {
  std::vector<T> values;
  const std::string_view text = array.text;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
    T value{};
    const auto [stop, error] = std::from_chars(text.data() + at, text.data() + end, value);
    if (error != std::errc() || stop != text.data() + end)
      bad_input("{}: array {}: found \"{}\", expected a number of type {}", path.string(), array.name,
                text.substr(at, std::min<std::size_t>(end - at, 40)), array.type);
    if (values.size() == most)
      bad_input("{}: array {}: found more than {} values", path.string(), array.name, most);
    values.push_back(value);
    at = end;
  }
  return values;
}

template <typename T>
std::vector<T> values_in(const PolyXml& xml, const XmlArray& array, std::uint64_t most,
                         const fs::path& path) {
  if (array.format == XmlArray::Format::ascii) return parsed<T>(array, most, path);
  const std::string bytes = content(xml, array, most * sizeof(T), path);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  if (xml.big_endian) swap_bytes(std::span(values));
  return values;
}

template <typename Result>
std::vector<Result> numbers_in(const PolyXml& xml, const XmlArray& array, std::int64_t tuples,
                               const fs::path& path) {
  return with_type(array, path, [&]<typename T>(Tag<T>) {
    const std::uint64_t expected =
        static_cast<std::uint64_t>(tuples) * static_cast<std::uint64_t>(array.components);
    const auto values = values_in<T>(xml, array, expected, path);
    if (values.size() != expected)
      bad_input("{}: array {}: found {} values, expected {}", path.string(), array.name, values.size(),
                expected);
    std::vector<Result> numbers;
    numbers.reserve(values.size());
    for (const T value : values) {
      if constexpr (std::is_integral_v<Result> && std::is_same_v<T, std::uint64_t>)
        if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
          bad_input("{}: array {}: found {}, expected a smaller number", path.string(), array.name, value);
      numbers.push_back(static_cast<Result>(value));
    }
    return numbers;
  });
}

}  // namespace

bool is_floating(const XmlArray& array) {
  return array.type == "Float32" || array.type == "Float64";
}

bool is_text(const XmlArray& array) {
  return array.type == "String";
}

std::vector<double> doubles_in(const PolyXml& xml, const XmlArray& array, std::int64_t tuples,
                               const fs::path& path) {
  return numbers_in<double>(xml, array, tuples, path);
}

std::vector<std::int64_t> integers_in(const PolyXml& xml, const XmlArray& array, std::int64_t tuples,
                                      const fs::path& path) {
  if (is_floating(array))
    bad_input("{}: array {}: found type {}, expected integers", path.string(), array.name, array.type);
  return numbers_in<std::int64_t>(xml, array, tuples, path);
}

std::string text_in(const PolyXml& xml, const XmlArray& array, const fs::path& path) {
  const auto characters = values_in<std::int8_t>(xml, array, kLongestText, path);
  const auto end = std::find(characters.begin(), characters.end(), std::int8_t{0});
  return {characters.begin(), end};
}

}  // namespace pendular
