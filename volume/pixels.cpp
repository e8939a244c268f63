#include "volume/pixels.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <new>
#include <type_traits>

#include "base/error.h"

namespace pendular {
namespace {

/// Whether a volume has pixels of this type.
template <typename T>
constexpr bool kept = std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::uint16_t> ||
                      std::is_same_v<T, std::uint32_t> || std::is_same_v<T, float>;
template <typename T>
using Pixel = std::conditional_t<kept<T>, T, float>;

/// Calls f with a number of the type.
template <typename Function>
decltype(auto) with_type(Stored type, Function&& f) {
  switch (type) {
    case Stored::uint8:
      return f(std::uint8_t{});
    case Stored::uint16:
      return f(std::uint16_t{});
    case Stored::uint32:
      return f(std::uint32_t{});
    case Stored::int8:
      return f(std::int8_t{});
    case Stored::int16:
      return f(std::int16_t{});
    case Stored::int32:
      return f(std::int32_t{});
    case Stored::int64:
      return f(std::int64_t{});
    case Stored::uint64:
      return f(std::uint64_t{});
    case Stored::float64:
      return f(double{});
    case Stored::float32:
      break;
  }
  return f(float{});
}

/// Bytes of memory that the machine has.
double memory() {
  return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

std::optional<Stored> stored_named(const std::string& name) {
  static const std::map<Stored, std::vector<std::string>> names = {
      {Stored::int8, {"char", "signed char", "int8", "int8_t"}},
      {Stored::uint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {Stored::int16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {Stored::uint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {Stored::int32, {"int", "signed int", "int32", "int32_t"}},
      {Stored::uint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {Stored::int64,
       {"longlong", "long_long", "long long", "long long int", "signed long long", "signed long long int",
        "int64", "int64_t"}},
      {Stored::uint64,
       {"ulonglong", "ulong_long", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {Stored::float32, {"float"}},
      {Stored::float64, {"double"}}};
  for (const auto& [type, words] : names)
    if (std::find(words.begin(), words.end(), name) != words.end()) return type;
  return std::nullopt;
}

bool is_kept(Stored type) {
  return with_type(type, []<typename T>(T) { return kept<T>; });
}

std::size_t width_of(Stored type) {
  return with_type(type, []<typename T>(T) { return sizeof(T); });
}

Volume::Pixels pixels_of(Stored type) {
  return with_type(type, []<typename T>(T) -> Volume::Pixels { return std::vector<Pixel<T>>(); });
}

void convert(std::span<const std::byte> numbers, Stored type, bool big_endian, Volume& volume,
             std::size_t first) {
  with_type(type, [&]<typename T>(T) {
    auto& pixels = std::get<std::vector<Pixel<T>>>(volume.pixels);
    for (std::size_t k = 0; k < numbers.size() / sizeof(T); ++k) {
      std::array<std::byte, sizeof(T)> number;
      std::memcpy(number.data(), numbers.data() + k * sizeof(T), sizeof(T));
      if (big_endian) std::reverse(number.begin(), number.end());
      pixels[first + k] = static_cast<Pixel<T>>(std::bit_cast<T>(number));
    }
  });
}

std::size_t bytes_per_voxel(const Volume& volume) {
  return std::visit([](const auto& pixels) { return sizeof(pixels[0]); }, volume.pixels);
}

char* bytes(Volume& volume) {
  return std::visit([](auto& pixels) { return reinterpret_cast<char*>(pixels.data()); }, volume.pixels);
}

void allocate(Volume& volume, const fs::path& path, std::uintmax_t data_bytes) {
  constexpr double deflate_limit = 1032.0;
  double claimed = static_cast<double>(bytes_per_voxel(volume));
  for (const std::size_t n : volume.size) claimed *= static_cast<double>(n);
  if (claimed < 1.0)
    bad_input("{}: found a volume of {} x {} x {} voxels, expected at least one", path.string(),
              volume.size[0], volume.size[1], volume.size[2]);
  if (claimed > deflate_limit * static_cast<double>(data_bytes))
    bad_input("{}: found {} bytes, expected the {:.0f} of {} x {} x {} voxels", path.string(), data_bytes,
              claimed, volume.size[0], volume.size[1], volume.size[2]);
  const auto no_room = [&] {
    throw ComputationFailed(fmt::format("{}: out of memory: its {} x {} x {} voxels take {:.3g} GB",
                                        path.string(), volume.size[0], volume.size[1], volume.size[2],
                                        1e-9 * claimed));
  };
  if (claimed > memory()) no_room();
  try {
    std::visit([&](auto& pixels) { pixels.resize(volume.voxels()); }, volume.pixels);
  } catch (const std::bad_alloc&) {
    no_room();
  }
}

}  // namespace pendular
