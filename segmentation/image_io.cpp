#include "segmentation/image_io.h"

#include <fcntl.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkPNGImageIO.h>
#include <itkTIFFImageIO.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

#include "base/progress.h"
#include "segmentation/resample.h"

namespace pendular {
namespace {

/// The length of one header unit, m; µm where the file does not name it. ITK does not pass on an NRRD's
/// units.
double header_unit(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".nrrd" && extension != ".nhdr") return 1e-6;
  static const std::map<std::string, double> known = {{"m", 1.0},       {"cm", 1e-2},      {"mm", 1e-3},
                                                      {"um", 1e-6},     {"\u00b5m", 1e-6}, {"\u03bcm", 1e-6},
                                                      {"micron", 1e-6}, {"microns", 1e-6}, {"nm", 1e-9}};
  std::ifstream in(path, std::ios::binary);
  for (std::string line; std::getline(in, line) && !line.empty() && line != "\r";) {
    if (line.rfind("space units:", 0) != 0 && line.rfind("units:", 0) != 0) continue;
    const auto first = line.find('"');
    const auto last = line.find('"', first + 1);
    const std::string unit = last == std::string::npos ? "" : line.substr(first + 1, last - first - 1);
    const auto found = known.find(unit);
    if (found == known.end())
      bad_input("{}: {}: found no known length unit, expected \"m\", \"cm\", \"mm\", \"um\" or \"nm\"",
                path.string(), line);
    return found->second;
  }
  return 1e-6;
}

}  // namespace

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
  return line.substr(0, line.find_first_of("\r\n"));
}

itk::ImageIOBase::Pointer reader_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  itk::ImageIOBase::Pointer io;
  if (extension == ".mha" || extension == ".mhd") io = itk::MetaImageIO::New();
  if (extension == ".nrrd" || extension == ".nhdr") io = itk::NrrdImageIO::New();
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

std::size_t bytes_per_voxel(const Volume& volume) {
  return std::visit([](const auto& pixels) { return sizeof(pixels[0]); }, volume.pixels);
}

char* bytes(Volume& volume) {
  return std::visit([](auto& pixels) { return reinterpret_cast<char*>(pixels.data()); }, volume.pixels);
}

void allocate(Volume& volume, const fs::path& path, std::uintmax_t data_bytes) {
  constexpr double deflate_limit = 1032.0;
  double claimed = static_cast<double>(bytes_per_voxel(volume));
  for (const std::size_t n : volume.size) claimed *= static_cast<double>(n);
  if (claimed < 1.0)
    bad_input("{}: found a volume of {} x {} x {} voxels, expected at least one", path.string(),
              volume.size[0], volume.size[1], volume.size[2]);
  if (claimed > deflate_limit * static_cast<double>(data_bytes))
    bad_input("{}: found {} bytes, expected the {:.0f} of {} x {} x {} voxels", path.string(), data_bytes,
              claimed, volume.size[0], volume.size[1], volume.size[2]);
  std::visit([&](auto& pixels) { pixels.resize(volume.voxels()); }, volume.pixels);
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

std::array<double, 3> place(Volume& volume, itk::ImageIOBase* io, const fs::path& path,
                            const ReadOptions& options) {
  std::optional<double> spacing = options.spacing;
  std::array<double, 3> edges{1.0, 1.0, 1.0};
  if (io) {
    const double unit = header_unit(path);
    std::array<double, 3> header;
    for (unsigned axis = 0; axis < 3; ++axis) header[axis] = std::abs(io->GetSpacing(axis));
    if (!options.spacing) edges = over_shortest(header, path);
    const double shortest = *std::min_element(header.begin(), header.end());
    const bool stated = shortest > 0.0 && (shortest != 1.0 || edges != std::array{1.0, 1.0, 1.0});
    if (!spacing && stated) spacing = shortest * unit;
    for (unsigned axis = 0; axis < 3; ++axis)  // an offset in voxels follows an overriding voxel size
      volume.origin[axis] =
          stated && spacing ? io->GetOrigin(axis) / shortest * *spacing : io->GetOrigin(axis) * unit;
  }
  if (!spacing)
    warn(fmt::format(
        "{}: no voxel size in the file and no --voxel-um: taken as 1 um, so lengths are in voxels",
        path.string()));
  volume.spacing = spacing.value_or(1e-6);
  if (!(volume.spacing > 0.0) || !std::isfinite(volume.spacing))
    bad_input("{}: found a voxel size of {} um, expected a positive number", path.string(),
              volume.spacing * 1e6);
  return edges;
}

}  // namespace pendular
