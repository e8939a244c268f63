#include "volume/format.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scratch.h"

namespace pendular::segmentation {
namespace {

using test::ScratchFolder;

/// Two voxels that a text spells: "toy 1 2".
VolumeFormat toy() {
  return {
      .name = "toy of two voxels (.toy)",
      .recognises = [](const fs::path& path, const ReadOptions&) { return lower_extension(path) == ".toy"; },
      .read =
          [](const fs::path& path, const ReadOptions&) {
            std::string text = read_text(path);
            Volume volume;
            volume.size = {2, 1, 1};
            volume.pixels = std::vector<std::uint8_t>{static_cast<std::uint8_t>(text.at(4)),
                                                      static_cast<std::uint8_t>(text.at(6))};
            return volume;
          }};
}

std::string refusal_of(const fs::path& path) {
  try {
    read_volume(path);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(VolumeFormat, AnAddedOneIsReadAndNamedAsLongAsItLives) {
  const ScratchFolder folder;
  write_text(folder / "a.toy", "toy 1 2");
  write_text(folder / "a.txt", "text");
  EXPECT_NE(refusal_of(folder / "a.toy").find("found extension '.toy'"), std::string::npos);
  {
    const AddedFormat added(toy());
    EXPECT_EQ(read_volume(folder / "a.toy").voxels(), 2u);
    EXPECT_EQ(volume_files(folder / "a.toy"), (std::vector<fs::path>{folder / "a.toy"}));
    EXPECT_NE(refusal_of(folder / "a.txt").find("toy of two voxels (.toy)"), std::string::npos);
    EXPECT_TRUE(format_names().ends_with(" or toy of two voxels (.toy)"));
    EXPECT_THROW(AddedFormat{toy()}, BadInput);
  }
  EXPECT_EQ(format_names().find("toy"), std::string::npos);
}

TEST(VolumeFormat, EachIsNamedInTheMessageAboutAnUnknownOne) {
  const ScratchFolder folder;
  write_text(folder / "a.txt", "text");
  const std::string said = refusal_of(folder / "a.txt");
  for (const auto& format : volume_formats()) EXPECT_NE(said.find(format.name), std::string::npos) << said;
}

}  // namespace
}  // namespace pendular::segmentation
