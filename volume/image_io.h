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

/// The header of one file, which is grey.
void read_header(itk::ImageIOBase& io, const fs::path& path);

/// What a file's numbers are, its header having been read. BadInput for what is no number.
Stored stored_type(const itk::ImageIOBase& io, const fs::path& path);

/// Of a TIFF or PNG. BadInput also for whole numbers of 32 bit, which ITK's reader takes for zeros.
Stored picture_type(const itk::ImageIOBase& io, const fs::path& path);

/// All voxels of a file become the volume's, which has the type for them, from the `first` on.
void read_pixels(itk::ImageIOBase& io, const fs::path& path, Volume& volume, std::size_t first);

/// A picture of width × height pixels of red, green, blue, rows from the top, as a PNG: whole or not at all.
/// ComputationFailed where it cannot be written.
void write_png(const fs::path& path, std::size_t width, std::size_t height,
               std::span<const std::uint8_t> pixels);

}  // namespace pendular
