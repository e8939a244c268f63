#include "volume/image_io.h"

#include <fcntl.h>
#include <itkPNGImageIO.h>
#include <itkTIFFImageIO.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <regex>

#include "base/columns.h"
#include "base/progress.h"
#include "volume/resample.h"

namespace pendular {

QuietLibraries::QuietLibraries() : saved_(::dup(STDERR_FILENO)) {
  std::fflush(stderr);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

QuietLibraries::~QuietLibraries() {
  std::fflush(stderr);
  if (saved_ < 0) return;
  ::dup2(saved_, STDERR_FILENO);
  ::close(saved_);
}

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

std::string first_line(const char* text) {
  const std::string line(text);
  static const std::regex address(" ?\\(0x[0-9a-fA-F]+\\)");  // of the object that complains
  return std::regex_replace(line.substr(0, line.find_first_of("\r\n")), address, "");
}

itk::ImageIOBase::Pointer reader_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  itk::ImageIOBase::Pointer io;
  if (extension == ".tif" || extension == ".tiff") io = itk::TIFFImageIO::New();
  if (extension == ".png") io = itk::PNGImageIO::New();
  if (!io)
    bad_input(
        "{}: found extension '{}', expected .mha, .mhd, .nrrd, .nhdr, .tif, .tiff, a folder of slices, or "
        "raw data with --size",
        path.string(), extension);
  io->SetFileName(path.string());
  return io;
}

void read_header(itk::ImageIOBase& io, const fs::path& path) {
  guarded(path, [&] {
    if (!io.CanReadFile(path.c_str()))
      bad_input("{}: found no image of the kind its name says, expected one", path.string());
    io.ReadImageInformation();
  });
  if (io.GetNumberOfComponents() != 1 || io.GetPixelType() != itk::IOPixelEnum::SCALAR)
    bad_input("{}: found {} components per voxel, expected one (grey)", path.string(),
              io.GetNumberOfComponents());
}

void read_pixels(itk::ImageIOBase& io, const fs::path& path, char* target) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis) {
    region.SetIndex(axis, 0);
    region.SetSize(axis, io.GetDimensions(axis));
  }
  io.SetIORegion(region);
  guarded(path, [&] { io.Read(target); });
}

Volume::Pixels pixels_of(itk::IOComponentEnum type, const fs::path& path) {
  switch (type) {
    case itk::IOComponentEnum::UCHAR:
      return std::vector<std::uint8_t>();
    case itk::IOComponentEnum::USHORT:
      return std::vector<std::uint16_t>();
    case itk::IOComponentEnum::FLOAT:
      return std::vector<float>();
    case itk::IOComponentEnum::UINT:
      return std::vector<std::uint32_t>();
    default:
      bad_input("{}: found pixel type {}, expected unsigned 8 or 16 bit or float", path.string(),
                itk::ImageIOBase::GetComponentTypeAsString(type));
  }
}

Volume::Pixels pixels_of(const std::string& type) {
  if (type == "uint8") return std::vector<std::uint8_t>();
  if (type == "uint16") return std::vector<std::uint16_t>();
  if (type == "float") return std::vector<float>();
  throw BadUsage(fmt::format("--type: found '{}', expected uint8, uint16 or float", type));
}

std::array<double, 3> over_shortest(const std::array<double, 3>& edges, const fs::path& path) {
  constexpr double alike = 1e-3, most = 8.0;
  const auto [shortest, longest] = std::minmax_element(edges.begin(), edges.end());
  if (!(*shortest > 0.0) || !(*longest <= most * *shortest))
    bad_input("{}: found voxels of {} x {} x {}, expected edges within a factor of {}", path.string(),
              edges[0], edges[1], edges[2], most);
  std::array<double, 3> over{1.0, 1.0, 1.0};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (edges[axis] > (1.0 + alike) * *shortest) over[axis] = edges[axis] / *shortest;
  return over;
}

Volume made_cubic(Volume volume, const std::array<double, 3>& edges, const fs::path& path) {
  if (edges == std::array{1.0, 1.0, 1.0}) return volume;
  warn(fmt::format("{}: voxels of {:.4g} x {:.4g} x {:.4g} um: taken to cubic ones of {:.4g} um between them",
                   path.string(), 1e6 * volume.spacing * edges[0], 1e6 * volume.spacing * edges[1],
                   1e6 * volume.spacing * edges[2], 1e6 * volume.spacing));
  return resampled(volume, edges);
}

void check_place(const Volume& volume, const fs::path& path) {
  constexpr Range voxel{1e-3, 1e4};  // um
  require_in_range(path.string(), "voxel size, um", voxel, 1e6 * volume.spacing);
  for (int axis = 0; axis < 3; ++axis)
    require_in_range(path.string(), "origin, um", range_of("x_um"), 1e6 * volume.origin[axis]);
}

std::array<double, 3> place(Volume& volume, const Placement* header, const fs::path& path,
                            const ReadOptions& options) {
  std::optional<double> spacing = options.spacing;
  std::array<double, 3> edges{1.0, 1.0, 1.0};
  if (header) {
    if (!options.spacing) edges = over_shortest(header->spacing, path);
    const double shortest = *std::min_element(header->spacing.begin(), header->spacing.end());
    const bool stated = shortest != 1.0 || edges != std::array{1.0, 1.0, 1.0};
    if (!spacing && stated) spacing = shortest * header->unit;
    for (std::size_t axis = 0; axis < 3; ++axis)  // an offset in voxels follows an overriding voxel size
      volume.origin[static_cast<Eigen::Index>(axis)] = stated && spacing
                                                           ? header->origin[axis] / shortest * *spacing
                                                           : header->origin[axis] * header->unit;
  }
  if (!spacing)
    warn(fmt::format(
        "{}: no voxel size in the file and no --voxel-um: taken as 1 um, so lengths are in voxels",
        path.string()));
  volume.spacing = spacing.value_or(1e-6);
  check_place(volume, path);
  return edges;
}

}  // namespace pendular
