#include "volume/read_slices.h"

#include <algorithm>
#include <tuple>

#include "base/interrupt.h"
#include "base/path_kind.h"
#include "base/progress.h"
#include "volume/format.h"
#include "volume/image_io.h"

namespace pendular {
namespace {

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
  for (const auto& file : slice_files(folder)) slices.push_back(slice_name(file));
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

}  // namespace

std::vector<fs::path> slice_files(const fs::path& folder) {
  std::vector<fs::path> files = files_in(folder);
  std::erase_if(files, [](const fs::path& file) {
    const std::string extension = lower_extension(file);
    return file.filename().string().front() == '.' ||
           (extension != ".tif" && extension != ".tiff" && extension != ".png");
  });
  return files;
}

Volume read_slices(const fs::path& folder, const ReadOptions& options) {
  const auto slices = slices_of(folder);
  Volume volume;
  Stored first{};
  Progress progress("reading slices", static_cast<double>(slices.size()));
  for (std::size_t k = 0; k < slices.size(); ++k) {
    stop_if_interrupted();
    const fs::path& path = slices[k].path;
    const auto io = reader_of(path);
    read_header(*io, path);
    if (io->GetNumberOfDimensions() > 2 && io->GetDimensions(2) > 1)
      bad_input("{}: found {} pages in one slice, expected one", path.string(), io->GetDimensions(2));
    const Stored type = picture_type(*io, path);
    if (k == 0) {
      first = type;
      volume.size = {io->GetDimensions(0), io->GetDimensions(1), slices.size()};
      volume.pixels = pixels_of(type);
      allocate(volume, path, slices.size() * fs::file_size(path));
    }
    if (io->GetDimensions(0) != volume.size[0] || io->GetDimensions(1) != volume.size[1])
      bad_input("{}: found a slice of {} x {}, expected {} x {} as the first", path.string(),
                io->GetDimensions(0), io->GetDimensions(1), volume.size[0], volume.size[1]);
    if (type != first)
      bad_input("{}: found another pixel type, expected {} as in the first slice", path.string(),
                pixel_type(volume));
    read_pixels(*io, path, volume, k * volume.size[0] * volume.size[1]);
    progress.update(static_cast<double>(k + 1));
  }
  place(volume, nullptr, folder, options);
  return volume;
}

VolumeFormat formats::slices() {
  return {.name = "folder of TIFF or PNG slices",
          .recognises = [](const fs::path& path, const ReadOptions&) { return is_folder(path); },
          .files = slice_files,
          .read = read_slices};
}

}  // namespace pendular
