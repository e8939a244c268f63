#pragma once

// Files of images through ITK, with one line for whatever is wrong with them. Internal to segmentation.

#include "volume/itk_images.h"

#include "base/error.h"
#include "volume/pixels.h"
#include "volume/volume.h"
#include "volume/voxel_header.h"

namespace pendular {

/// Sends standard error nowhere while a library works that prints its own warnings there: the user is to read
/// one line.
class QuietLibraries {
 public:
  QuietLibraries();
  ~QuietLibraries();
  QuietLibraries(const QuietLibraries&) = delete;
  QuietLibraries& operator=(const QuietLibraries&) = delete;

 private:
  int saved_;
};

std::string lower_extension(const fs::path& path);

/// Everything before the first line break, without addresses in memory.
std::string first_line(const char* text);

/// Runs a call into ITK; its exceptions become one line about `path`.
template <typename Call>
void guarded(const fs::path& path, const Call& call) {
  const QuietLibraries quiet;
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

/// No pixels yet, of that type. BadInput, or BadUsage for the option's word, for any other.
Volume::Pixels pixels_of(itk::IOComponentEnum type, const fs::path& path);
Volume::Pixels pixels_of(const std::string& type);

/// Voxel size and origin from a header (null: none that is meant) and options. Where the header's voxels are
/// not cubic and the options do not overrule it, the size is that of the shortest edge. Returns the edges
/// over it. BadInput for a size from beyond 1 nm to 1 cm, and for an origin farther than a metre.
std::array<double, 3> place(Volume& volume, const Placement* header, const fs::path& path,
                            const ReadOptions& options);

/// BadInput where the voxel size or the origin cannot be meant.
void check_place(const Volume& volume, const fs::path& path);

/// Edges over the shortest; ones where they agree to a thousandth. BadInput beyond a factor of eight.
std::array<double, 3> over_shortest(const std::array<double, 3>& edges, const fs::path& path);

/// The volume on cubic voxels, with a warning where it was not.
Volume made_cubic(Volume volume, const std::array<double, 3>& edges, const fs::path& path);

}  // namespace pendular
