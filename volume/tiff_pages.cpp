#include "volume/format.h"
#include "volume/image_io.h"

namespace pendular {
namespace {

bool recognises(const fs::path& path, const ReadOptions&) {
  const std::string extension = lower_extension(path);
  return extension == ".tif" || extension == ".tiff" || extension == ".png";
}

/// The resolution tag is a printer's and rarely the scanner's.
Volume read_pages(const fs::path& path, const ReadOptions& options) {
  const auto io = reader_of(path);
  read_header(*io, path);
  if (io->GetNumberOfDimensions() != 3)
    bad_input("{}: found an image of {} dimensions, expected 3", path.string(), io->GetNumberOfDimensions());
  Volume volume;
  volume.pixels = pixels_of(picture_type(*io, path));
  for (unsigned axis = 0; axis < 3; ++axis) volume.size[axis] = io->GetDimensions(axis);
  place(volume, nullptr, path, options);
  allocate(volume, path, fs::file_size(path));
  read_pixels(*io, path, volume, 0);
  return volume;
}

}  // namespace

/// Pages are slices. A PNG is recognised so that it is told what it lacks.
VolumeFormat formats::tiff() {
  return {.name = "multi-page TIFF (.tif, .tiff)", .recognises = recognises, .read = read_pages};
}

}  // namespace pendular
