#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

#include "base/error.h"
#include "base/inflate.h"
#include "base/interrupt.h"
#include "volume/header_text.h"
#include "volume/pixels.h"
#include "volume/place.h"
#include "volume/voxel_header.h"

namespace pendular {
namespace {

static_assert(std::endian::native == std::endian::little, "voxels are swapped where they are big endian");

using Encoding = VoxelHeader::Encoding;

[[noreturn]] void wrong_amount(const fs::path& file, std::uint64_t found, std::uint64_t expected,
                               const char* more = "") {
  bad_input("{}: found {} bytes of voxels{}, expected {}: truncated, or sizes or type do not match",
            file.string(), found, more, expected);
}

/// What is stored of the voxels in a file.
std::span<const std::byte> stored_in(const VoxelHeader& header, const fs::path& path,
                                     const MappedFile& file) {
  const std::span<const std::byte> all(file.data(), file.size());
  const std::uint64_t expected = header.stored.value_or(header.bytes_per_file());
  const bool whole = header.encoding == Encoding::raw || header.stored;  // the amount is known
  if (header.at_end) {
    if (!whole || all.size() < expected) wrong_amount(path, all.size(), expected);
    return all.last(expected);
  }
  const auto rest = all.subspan(std::min<std::uint64_t>(header.first_byte, all.size()));
  if (whole && rest.size() != expected) wrong_amount(path, rest.size(), expected);
  return rest;
}

/// Whether voxels are stored as a volume has them.
bool as_in_memory(const VoxelHeader& header) {
  return is_kept(header.type) && !header.big_endian;
}

void inflate_voxels(const VoxelHeader& header, const fs::path& path, std::span<const std::byte> stored,
                    Volume& volume) {
  constexpr std::uint64_t much = 1 << 26,
                          rarely = 20;  // bytes, and times the stored ones: not believed unseen
  const std::uint64_t expected = header.bytes_per_file();
  if (expected > much && expected > rarely * stored.size())
    if (const std::uint64_t found = inflated_size(stored, expected); found != expected)
      wrong_amount(path, found, expected, " once inflated");
  allocate(volume, path, stored.size());
  std::vector<std::byte> numbers(as_in_memory(header) ? 0 : expected);
  const std::uint64_t found = inflate_into(
      stored, as_in_memory(header) ? std::span(reinterpret_cast<std::byte*>(bytes(volume)), expected)
                                   : std::span(numbers));
  if (found != expected)
    wrong_amount(path, found, expected, found > expected ? " or more once inflated" : " once inflated");
  if (!as_in_memory(header)) convert(numbers, header.type, header.big_endian, volume, 0);
}

/// Whole numbers or decimal ones, parted by white space.
void parse_voxels(const fs::path& path, std::span<const std::byte> stored, Volume& volume, std::size_t first,
                  std::size_t count) {
  const std::string_view text(reinterpret_cast<const char*>(stored.data()), stored.size());
  std::visit(
      [&]<typename T>(std::vector<T>& pixels) {
        std::size_t at = 0, done = 0;
        const auto skip = [&] { at = std::min(text.find_first_not_of(" \t\r\n", at), text.size()); };
        for (skip(); at < text.size(); skip(), ++done) {
          const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
          if (done == count)
            bad_input("{}: found more than {} voxels, expected so many", path.string(), count);
          const std::string_view word = text.substr(at, std::min<std::size_t>(end - at, 40));
          if constexpr (std::is_same_v<T, float>)
            pixels[first + done] = static_cast<float>(to_number(path.string() + ": voxels", word));
          else
            pixels[first + done] = static_cast<T>(
                to_integer(path.string() + ": voxels", word, 0, std::numeric_limits<T>::max()));
          at = end;
        }
        if (done != count) bad_input("{}: found {} voxels, expected {}", path.string(), done, count);
      },
      volume.pixels);
}

/// Room for all voxels, once the files are seen to be large enough for them.
void make_room(const VoxelHeader& header, const fs::path& path, Volume& volume) {
  const std::uint64_t width = width_of(header.type), each = header.bytes_per_file();
  const std::uint64_t least = header.encoding == Encoding::text ? 2 * (each / width) - 1 : each;
  std::uintmax_t there = 0;
  for (const auto& file : header.files) {
    const std::uintmax_t size = fs::file_size(file),
                         skipped = std::min<std::uintmax_t>(size, header.first_byte);
    if (size - skipped < least) wrong_amount(file, size - skipped, least);
    there += size;
  }
  allocate(volume, path, there);
}

}  // namespace

std::uint64_t VoxelHeader::bytes_per_file() const {
  return std::uint64_t{width_of(type)} * size[0] * size[1] * size[2] / files.size();
}

void read_voxels(const VoxelHeader& header, const fs::path& path, Volume& volume) {
  if (header.encoding == Encoding::raw && header.files.size() == 1 && as_in_memory(header)) {
    volume.file = std::make_shared<MappedFile>(header.files[0]);
    const auto stored = stored_in(header, header.files[0], *volume.file);
    volume.first_byte = static_cast<std::size_t>(stored.data() - volume.file->data());
    return;
  }
  if (header.encoding == Encoding::deflated) {
    const MappedFile file(header.files[0]);
    inflate_voxels(header, path, stored_in(header, header.files[0], file), volume);
    return;
  }
  make_room(header, path, volume);
  const std::uint64_t each = header.bytes_per_file() / width_of(header.type);
  for (std::size_t k = 0; k < header.files.size(); ++k) {
    stop_if_interrupted();
    const MappedFile file(header.files[k]);
    const auto stored = stored_in(header, header.files[k], file);
    if (header.encoding == Encoding::text)
      parse_voxels(header.files[k], stored, volume, k * each, each);
    else
      convert(stored, header.type, header.big_endian, volume, k * each);
  }
}

Volume read_with_header(const VoxelHeader& header, const fs::path& path, const ReadOptions& options) {
  Volume volume;
  volume.size = header.size;
  volume.pixels = pixels_of(header.type);
  const auto edges = place(volume, &header.place, path, options);
  read_voxels(header, path, volume);
  return made_cubic(std::move(volume), edges, path);
}

std::vector<fs::path> files_of(const fs::path& path, const VoxelHeader& header) {
  std::vector<fs::path> files = {path};
  files.insert(files.end(), header.files.begin(), header.files.end());
  return files;
}

}  // namespace pendular
