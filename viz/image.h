#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/files.h"

namespace pendular::viz {

/// A picture: 8-bit red, green, blue per pixel, rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 × width × height

  std::array<std::uint8_t, 3> pixel(int x, int y) const {
    const std::size_t k =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[k], rgb[k + 1], rgb[k + 2]};
  }
};

/// Width and height in pixels.
struct PictureSize {
  int width = 1600, height = 1200;
};

/// Writes a PNG file whole or not at all; `comment` goes into its text chunk "Comment" where not empty.
void write_png(const fs::path& path, const Image& image, const std::string& comment = "");

}  // namespace pendular::viz
