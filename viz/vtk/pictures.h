#pragma once

#include "viz/rendering.h"

// What viz/rendering.h offers, function by function.

namespace pendular::viz {

std::unique_ptr<ScenePictures> scene_pictures(_XDisplay* connection, PictureSize size);
std::vector<Image> bead_map_pictures(_XDisplay* connection, std::span<const BeadMap> maps, PictureSize size);
bool write_png_file(const fs::path& path, const Image& image, const std::string& comment);
std::string jpeg_thumbnail(const fs::path& picture, int width);

}  // namespace pendular::viz
