#include "volume/pixels.h"

#include <unistd.h>

#include <new>

#include "base/error.h"

namespace pendular {
namespace {

/// Bytes of memory that the machine has.
double memory() {
  return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

Volume::Pixels pixels_of(const std::string& type) {
  if (type == "uint8") return std::vector<std::uint8_t>();
  if (type == "uint16") return std::vector<std::uint16_t>();
  if (type == "float") return std::vector<float>();
  throw BadUsage(fmt::format("--type: found '{}', expected uint8, uint16 or float", type));
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
