#include "mutation.h"

#include "scratch.h"
#include "volume/volume.h"

namespace pendular::segmentation {
namespace {

using test::read_mutations;
using test::ScratchFolder;

Volume small_volume() {
  Volume volume;
  volume.size = {9, 8, 7};
  std::vector<std::uint16_t> pixels;
  for (std::size_t k = 0; k < volume.voxels(); ++k)
    pixels.push_back(static_cast<std::uint16_t>(random_bits(1, k)));
  volume.pixels = pixels;
  return volume;
}

TEST(Mutation, NoDamageToAVolumeCrashesItsReader) {
  ScratchFolder folder;
  write_volume(folder / "v.mha", small_volume());
  const std::string mha = read_text(folder / "v.mha");
  read_mutations(folder / "v.mha", mha, 400, [](const fs::path& path) { read_volume(path); });

  const std::string nrrd =
      "NRRD0004\ntype: unsigned short\ndimension: 3\nsizes: 9 8 7\nendian: little\nencoding: raw\nspacings: "
      "5 5 5\n\n" +
      mha.substr(mha.size() - 2 * 9 * 8 * 7);
  read_mutations(folder / "v.nrrd", nrrd, 400, [](const fs::path& path) { read_volume(path); });

  write_text(folder / "v.vol", mha.substr(mha.size() - 2 * 9 * 8 * 7));
  const std::string pcr =
      "[VolumeData]\nVOL_File=v.vol\nVoxelSizeRec=0.005\nFormat=5\nVolume_SizeX=9\nVolume_SizeY=8\nVolume_"
      "SizeZ=7\n";
  read_mutations(folder / "v.pcr", pcr, 400, [](const fs::path& path) { read_volume(path); });
}

}  // namespace
}  // namespace pendular::segmentation
