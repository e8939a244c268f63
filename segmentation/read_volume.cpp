#include "segmentation/itk_images.h"

#include <fcntl.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkPNGImageIO.h>
#include <itkTIFFImageIO.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "segmentation/phoenix.h"
#include "segmentation/volume.h"

namespace pendular {
namespace {

static_assert(std::endian::native == std::endian::little, "headerless files are read as little endian");

/// Sends standard error nowhere while a library works that prints its own warnings there: the user is to read
/// one line.
class QuietLibraries {
 public:
  QuietLibraries() : saved_(::dup(STDERR_FILENO)) {
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ~QuietLibraries() {
    std::fflush(stderr);
    if (saved_ < 0) return;
    ::dup2(saved_, STDERR_FILENO);
    ::close(saved_);
  }
  QuietLibraries(const QuietLibraries&) = delete;
  QuietLibraries& operator=(const QuietLibraries&) = delete;

 private:
  int saved_;
};

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
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

/// Everything before the first line break.
std::string first_line(const char* text) {
  const std::string line(text);
  return line.substr(0, line.find_first_of("\r\n"));
}

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

/// The header of one file: grey, of a pixel type that is kept as it is.
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

/// Makes room for the pixels. A header may claim any size; what compression cannot have shrunk to
/// `data_bytes` is not there.
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

/// MetaIO reads truncated data without an error, so the amount of data is checked here.
/// `voxel_bytes`: what the header asks for.
void check_metaimage_data(const fs::path& header, std::uintmax_t voxel_bytes) {
  std::ifstream in(header, std::ios::binary);
  std::map<std::string, std::string> field;
  constexpr int most_lines = 1000;
  std::string line;
  for (int k = 0; k < most_lines && !field.count("ElementDataFile") && std::getline(in, line); ++k) {
    const auto equals = line.find('=');
    if (equals == std::string::npos) continue;
    const auto trimmed = [](std::string word) {
      word.erase(0, word.find_first_not_of(" \t\r"));
      word.erase(word.find_last_not_of(" \t\r") + 1);
      return word;
    };
    field[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  const std::string file = field["ElementDataFile"];
  if (file == "LIST" || file.find('%') != std::string::npos) return;
  const bool local = file == "LOCAL" || file == "Local" || file == "local";
  const fs::path data = local ? header : header.parent_path() / file;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(data, error);
  if (error)
    bad_input("{}: ElementDataFile: found no file '{}', expected the voxels there", header.string(),
              data.string());
  const bool compressed = !field["CompressedData"].empty() && std::toupper(field["CompressedData"][0]) == 'T';
  if (compressed && field["CompressedDataSize"].empty()) return;
  const std::uintmax_t expected =
      compressed ? std::strtoull(field["CompressedDataSize"].c_str(), nullptr, 10) : voxel_bytes;
  std::uintmax_t skipped = local ? static_cast<std::uintmax_t>(in.tellg()) : 0;
  if (!field["HeaderSize"].empty() && !local)
    skipped = std::max(0LL, std::atoll(field["HeaderSize"].c_str()));
  if (size - std::min(size, skipped) != expected)
    bad_input("{}: found {} bytes of voxels, expected {}: truncated, or DimSize or ElementType do not match",
              data.string(), size - std::min(size, skipped), expected);
}

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

/// Voxel size and origin from header and options.
void place(Volume& volume, itk::ImageIOBase* io, const fs::path& path, const ReadOptions& options) {
  std::optional<double> spacing = options.spacing;
  if (io) {
    const double unit = header_unit(path);
    const double first = io->GetSpacing(0);
    for (unsigned axis = 0; axis < 3; ++axis)
      if (!options.spacing && !(std::abs(io->GetSpacing(axis) - first) <= 1e-3 * std::abs(first)))
        bad_input("{}: found voxels of {} x {} x {}, expected cubic ones (or the edge by --voxel-um)",
                  path.string(), io->GetSpacing(0), io->GetSpacing(1), io->GetSpacing(2));
    const bool stated = std::abs(first) > 0.0 && first != 1.0;
    if (!spacing && stated) spacing = std::abs(first) * unit;
    for (unsigned axis = 0; axis < 3; ++axis)  // an offset in voxels follows an overriding voxel size
      volume.origin[axis] =
          stated && spacing ? io->GetOrigin(axis) / std::abs(first) * *spacing : io->GetOrigin(axis) * unit;
  }
  if (!spacing)
    warn(fmt::format(
        "{}: no voxel size in the file and no --voxel-um: taken as 1 um, so lengths are in voxels",
        path.string()));
  volume.spacing = spacing.value_or(1e-6);
  if (!(volume.spacing > 0.0) || !std::isfinite(volume.spacing))
    bad_input("{}: found a voxel size of {} um, expected a positive number", path.string(),
              volume.spacing * 1e6);
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

Volume read_one_file(const fs::path& path, const ReadOptions& options) {
  const auto io = reader_of(path);
  read_header(*io, path);
  unsigned dimensions = io->GetNumberOfDimensions();
  while (dimensions > 3 && io->GetDimensions(dimensions - 1) == 1) --dimensions;
  if (dimensions != 3)
    bad_input("{}: found an image of {} dimensions, expected 3", path.string(), dimensions);
  Volume volume;
  volume.pixels = pixels_of(io->GetComponentType(), path);
  for (unsigned axis = 0; axis < 3; ++axis) volume.size[axis] = io->GetDimensions(axis);
  const std::string extension = lower_extension(path);
  const bool meta = extension == ".mha" || extension == ".mhd";
  if (meta) {
    std::uintmax_t voxels = 1;
    for (const std::size_t n : volume.size) voxels *= n;
    check_metaimage_data(path, voxels * bytes_per_voxel(volume));
  }
  const bool detached = extension == ".mhd" || extension == ".nhdr";
  allocate(volume, path, detached ? std::numeric_limits<std::uintmax_t>::max() : fs::file_size(path));
  // The resolution tag of a TIFF is a printer's and rarely the scanner's.
  const bool spacing_is_meant = meta || extension == ".nrrd" || extension == ".nhdr";
  place(volume, spacing_is_meant ? io.GetPointer() : nullptr, path, options);
  read_pixels(*io, path, bytes(volume));
  return volume;
}

/// Splits "scan_0012.tif" into "scan_", 12, ".tif" (the last number of the stem; -1: none).
struct SliceName {
  fs::path path;
  std::string prefix, suffix;
  long long number = -1;
};

SliceName slice_name(const fs::path& path) {
  SliceName name{path, "", "", -1};
  const std::string text = path.filename().string();
  const auto stop = text.rfind('.');
  const auto last = text.find_last_of("0123456789", stop);
  if (last == std::string::npos) {
    name.prefix = text;
    return name;
  }
  auto first = last;
  while (first > 0 && std::isdigit(static_cast<unsigned char>(text[first - 1]))) --first;
  name.prefix = text.substr(0, first);
  name.suffix = text.substr(last + 1);
  const std::string digits = text.substr(first, last + 1 - first);
  if (digits.size() > 15)
    bad_input("{}: found a slice number of {} digits, expected at most 15", path.string(), digits.size());
  name.number = std::stoll(digits);
  return name;
}

/// The slices of a folder in the order of their numbers; BadInput for a hole.
std::vector<SliceName> slices_of(const fs::path& folder) {
  std::vector<SliceName> slices;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = lower_extension(entry.path());
    const bool image = extension == ".tif" || extension == ".tiff" || extension == ".png";
    if (image && entry.is_regular_file() && entry.path().filename().string().front() != '.')
      slices.push_back(slice_name(entry.path()));
  }
  if (slices.size() < 2)
    bad_input("{}: found {} TIFF or PNG slices, expected at least two", folder.string(), slices.size());
  std::sort(slices.begin(), slices.end(), [](const SliceName& a, const SliceName& b) {
    return std::tie(a.prefix, a.number, a.suffix) < std::tie(b.prefix, b.number, b.suffix);
  });
  long long step = slices[1].number - slices[0].number;
  for (std::size_t k = 1; k < slices.size(); ++k)
    step = std::min(step, slices[k].number - slices[k - 1].number);
  for (std::size_t k = 1; k < slices.size(); ++k) {
    const std::string name = slices[k].path.filename().string(),
                      before = slices[k - 1].path.filename().string();
    if (slices[k].prefix != slices[0].prefix || slices[k].suffix != slices[0].suffix)
      bad_input("{}: found '{}' beside '{}', expected slices of one series", folder.string(), name, before);
    if (step < 1 || slices[k].number - slices[k - 1].number != step)
      bad_input("{}: found '{}' right after '{}', expected no slice missing", folder.string(), name, before);
  }
  return slices;
}

Volume read_slices(const fs::path& folder, const ReadOptions& options) {
  const auto slices = slices_of(folder);
  Volume volume;
  Progress progress("reading slices", static_cast<double>(slices.size()));
  for (std::size_t k = 0; k < slices.size(); ++k) {
    stop_if_interrupted();
    const fs::path& path = slices[k].path;
    const auto io = reader_of(path);
    read_header(*io, path);
    if (io->GetNumberOfDimensions() > 2 && io->GetDimensions(2) > 1)
      bad_input("{}: found {} pages in one slice, expected one", path.string(), io->GetDimensions(2));
    const auto pixels = pixels_of(io->GetComponentType(), path);
    if (k == 0) {
      volume.size = {io->GetDimensions(0), io->GetDimensions(1), slices.size()};
      volume.pixels = pixels;
      allocate(volume, path, slices.size() * fs::file_size(path));
    }
    if (io->GetDimensions(0) != volume.size[0] || io->GetDimensions(1) != volume.size[1])
      bad_input("{}: found a slice of {} x {}, expected {} x {} as the first", path.string(),
                io->GetDimensions(0), io->GetDimensions(1), volume.size[0], volume.size[1]);
    if (pixels.index() != volume.pixels.index())
      bad_input("{}: found another pixel type, expected {} as in the first slice", path.string(),
                pixel_type(volume));
    read_pixels(*io, path, bytes(volume) + k * volume.size[0] * volume.size[1] * bytes_per_voxel(volume));
    progress.update(static_cast<double>(k + 1));
  }
  place(volume, nullptr, folder, options);
  return volume;
}

Volume read_raw(const fs::path& path, const ReadOptions& options) {
  Volume volume;
  volume.size = *options.raw_size;
  volume.pixels = pixels_of(options.raw_type);
  if (!options.spacing)
    throw BadUsage("--voxel-um: found nothing, expected the voxel size of headerless data");
  double expected = static_cast<double>(bytes_per_voxel(volume));
  for (const std::size_t n : volume.size) expected *= static_cast<double>(n);
  const auto size = fs::file_size(path);
  if (static_cast<double>(size) != expected)
    bad_input("{}: found {} bytes, expected {:.0f} for {} x {} x {} voxels of {}", path.string(), size,
              expected, volume.size[0], volume.size[1], volume.size[2], options.raw_type);
  allocate(volume, path, size);
  place(volume, nullptr, path, options);
  std::ifstream in(path, std::ios::binary);
  if (!in.read(bytes(volume), static_cast<std::streamsize>(size)))
    bad_input("{}: found data that ends early, expected {} bytes", path.string(), size);
  return volume;
}

/// A GE phoenix volume, by its .pcr or by the .vol beside one.
Volume read_phoenix(const fs::path& path, ReadOptions options) {
  const PhoenixVolume phoenix = read_pcr(fs::path(path).replace_extension(".pcr"));
  options.raw_size = phoenix.size;
  options.raw_type = phoenix.type;
  if (!options.spacing) options.spacing = phoenix.spacing;
  return read_raw(path.extension() == ".vol" ? path : phoenix.data, options);
}

/// Whether a file is a GE phoenix reconstruction.
bool is_phoenix(const fs::path& path) {
  return path.extension() == ".pcr" ||
         (path.extension() == ".vol" && fs::exists(fs::path(path).replace_extension(".pcr")));
}

/// Every grey value a number, and more than one of them.
void check_pixels(const Volume& volume, const fs::path& path) {
  with_pixels(volume, [&](auto pixels) {
    std::atomic<std::size_t> bad{pixels.size()};
    std::atomic<bool> varies{false};
    for_blocks(pixels.size(), 1 << 20, [&](std::size_t first, std::size_t last) {
      bool differs = false;
      std::size_t here = pixels.size();
      for (std::size_t k = first; k < last; ++k) {
        differs |= pixels[k] != pixels[0];
        if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(pixels[0])>>)
          if (here == pixels.size() && !std::isfinite(pixels[k])) here = k;
      }
      if (differs) varies = true;
      for (std::size_t least = bad; here < least && !bad.compare_exchange_weak(least, here);) {
      }
    });
    if (bad < pixels.size())
      bad_input("{}: voxel ({}, {}, {}): found NaN or infinity, expected a number", path.string(),
                bad % volume.size[0], bad / volume.size[0] % volume.size[1],
                bad / (volume.size[0] * volume.size[1]));
    if (!varies)
      bad_input("{}: found one grey value throughout ({}), expected beads", path.string(), pixels[0]);
  });
}

}  // namespace

Volume read_volume(const fs::path& path, const ReadOptions& options) {
  require_readable(path, true);
  if (options.raw_size && fs::is_directory(path))
    throw BadUsage("--size: found a folder of slices, expected headerless data");
  Volume volume = fs::is_directory(path) ? read_slices(path, options)
                  : options.raw_size     ? read_raw(path, options)
                  : is_phoenix(path)     ? read_phoenix(path, options)
                                         : read_one_file(path, options);
  check_pixels(volume, path);
  return volume;
}

}  // namespace pendular
