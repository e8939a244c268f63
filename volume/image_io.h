#pragma once

// Files of images through ITK, with one line for whatever is wrong with them. Internal to segmentation.

#include "volume/itk_images.h"

#include "base/error.h"
#include "base/own_process.h"
#include "volume/pixels.h"
#include "volume/place.h"
#include "volume/volume.h"

namespace pendular {

/// Everything before the first line break, without addresses in memory.
std::string first_line(const char* text);

/// Runs a call into ITK; its exceptions become one line about `path`.
template <typename Call>
void guarded(const fs::path& path, const Call& call) {
  const SilentStandardError silent;
  try {
    call();
  } catch (const itk::ExceptionObject& error) {
    bad_input("{}: found unreadable or truncated image data ({}), expected a complete image", path.string(),
              first_line(error.GetDescription()));
  }
}

/// The reader of a TIFF or PNG; BadInput for any other extension.
itk::ImageIOBase::Pointer reader_of(const fs::path& path);

/// The header of one file: grey, of a pixel type that is kept as it is.
void read_header(itk::ImageIOBase& io, const fs::path& path);

/// All voxels of a file, its header having been read.
void read_pixels(itk::ImageIOBase& io, const fs::path& path, char* target);

/// A picture of width × height pixels of red, green, blue, rows from the top, as a PNG: whole or not at all.
/// ComputationFailed where it cannot be written.
void write_png(const fs::path& path, std::size_t width, std::size_t height,
               std::span<const std::uint8_t> pixels);

/// No pixels yet, of that type. BadInput for any other.
Volume::Pixels pixels_of(itk::IOComponentEnum type, const fs::path& path);

}  // namespace pendular
