#include "fuzz.h"
#include "volume/voxel_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  static const bool slices = [] {
    for (const char* name : {"s1.raw", "s2.raw", "s3.raw"}) fuzz::put(name, "12345678");
    return true;
  }();
  return fuzz::read_bytes(data, slices ? size : 0, "v.nhdr", [](const fs::path& path) {
    const VoxelHeader header = read_nrrd_header(path);
    Volume volume;
    volume.size = header.size;
    volume.pixels = pixels_of(header.type);
    if (volume.voxels() < 1 << 20) read_voxels(header, path, volume);
  });
}
