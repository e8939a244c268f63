#include "volume/read_dicom.h"

#include "volume/dicom_library.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "base/interrupt.h"
#include "base/module.h"
#include "base/path_kind.h"
#include "base/process.h"
#include "base/progress.h"
#include "volume/format.h"
#include "volume/image_io.h"

namespace pendular {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr rlim_t kEnough = 6, kSpare = 1 << 29;  // memory: times the files, and bytes besides
constexpr double kUneven = 0.01;                 // of the distance of two slices

bool has_mark(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  char mark[4] = {};
  return in.seekg(128) && in.read(mark, 4) && std::memcmp(mark, "DICM", 4) == 0;
}

/// The files of a folder's only series, by position.
std::vector<fs::path> series_in(const fs::path& folder) {
  DicomSeries series;
  guarded(folder, [&] { series = dicom_library().series(folder.string()); });
  if (series.count != 1) bad_input("{}: found {} DICOM series, expected one", folder.string(), series.count);
  return {series.files.begin(), series.files.end()};
}

itk::ImageIOBase::Pointer opened(const fs::path& file) {
  auto io = dicom_library().reader();
  io->SetFileName(file.string());
  read_header(*io, file);
  return io;
}

Vec3 origin_of(const itk::ImageIOBase& io) {
  Vec3 origin = Vec3::Zero();
  for (unsigned axis = 0; axis < std::min(3u, io.GetNumberOfDimensions()); ++axis)
    origin[axis] = io.GetOrigin(axis);
  return origin;
}

std::size_t frames_of(const itk::ImageIOBase& io) {
  return io.GetNumberOfDimensions() > 2 ? io.GetDimensions(2) : 1;
}

/// Returns the edges of a voxel over the shortest.
std::array<double, 3> set_spacing(Volume& volume, const itk::ImageIOBase& first, double between,
                                  const fs::path& path, const ReadOptions& options) {
  const std::array<double, 3> edges{first.GetSpacing(0), first.GetSpacing(1),
                                    between > 0.0 ? between : first.GetSpacing(2)};
  volume.spacing = options.spacing.value_or(kMillimetre * *std::min_element(edges.begin(), edges.end()));
  volume.origin = kMillimetre * origin_of(first);
  check_place(volume, path);
  return options.spacing ? std::array{1.0, 1.0, 1.0} : over_shortest(edges, path);
}

Volume read_series(const fs::path& path, const ReadOptions& options) {
  const auto files = is_folder(path) ? series_in(path) : std::vector{path};
  Progress progress("reading slices", static_cast<double>(files.size()));
  const auto first = opened(files.front());
  Volume volume;
  volume.pixels = pixels_of(stored_type(*first, path));
  volume.size = {first->GetDimensions(0), first->GetDimensions(1),
                 files.size() > 1 ? files.size() : frames_of(*first)};
  if (volume.size[2] < 2) bad_input("{}: found one slice, expected a volume", path.string());
  allocate(volume, path, files.size() * fs::file_size(files.front()));
  double between = 0.0;
  Vec3 last = origin_of(*first);
  for (std::size_t k = 0; k < files.size(); ++k) {
    stop_if_interrupted();
    const auto io = k == 0 ? first : opened(files[k]);
    if (io->GetDimensions(0) != volume.size[0] || io->GetDimensions(1) != volume.size[1] ||
        io->GetComponentType() != first->GetComponentType() || (files.size() > 1 && frames_of(*io) > 1))
      bad_input("{}: found a slice of {} x {} or of another type, expected {} x {} as the first",
                files[k].string(), io->GetDimensions(0), io->GetDimensions(1), volume.size[0],
                volume.size[1]);
    const double step = (origin_of(*io) - last).norm();
    if (k == 1) between = step;
    if (k > 1 && std::fabs(step - between) > kUneven * between)
      bad_input("{}: found {:.6g} mm to the slice before it, expected {:.6g} as before (a slice missing?)",
                files[k].string(), step, between);
    last = origin_of(*io);
    read_pixels(*io, files[k], volume, k * volume.size[0] * volume.size[1]);
    progress.update(static_cast<double>(k + 1));
  }
  const auto edges = set_spacing(volume, *first, between, path, options);
  return made_cubic(std::move(volume), edges, path);
}

/// Addresses in use, bytes.
rlim_t in_use() {
  std::ifstream in("/proc/self/statm");
  rlim_t pages = 0;
  in >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

rlim_t bytes_in(const fs::path& path) {
  if (is_file(path)) return fs::file_size(path);
  rlim_t sum = 0;
  for (const auto& entry : fs::directory_iterator(path))
    if (is_file(entry.path())) sum += entry.file_size();
  return sum;
}

/// What is wrong with a volume; empty where it could be read. For a process that may be lost.
std::string complaint_about(const fs::path& path, const ReadOptions& options) {
  own_process();
  const SilentStandardError silent;
  const rlimit no_core = {0, 0}, memory = {in_use() + kEnough * bytes_in(path) + kSpare, RLIM_INFINITY};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::setrlimit(RLIMIT_AS, &memory);
  try {
    read_series(path, options);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

/// The library ends the process, or asks for any amount of memory, where it meets some kinds of damage, so
/// reading is tried in a process of its own first.
void try_reading(const fs::path& path, const ReadOptions& options) {
  const auto [status, complaint] = run_apart([&] { return complaint_about(path, options); });
  stop_if_interrupted();
  if (!complaint.empty()) throw BadInput(complaint);
  if (status != 0)
    bad_input("{}: found DICOM data that its reader cannot bear, expected undamaged files", path.string());
}

}  // namespace

const DicomLibrary& dicom_library() {
  static const auto* found =
      static_cast<const DicomLibrary*>(module_symbol(PENDULAR_DICOM, "pendular_dicom"));
  return *found;
}

bool is_dicom(const fs::path& path) {
  if (is_file(path)) return has_mark(path);
  if (!is_folder(path)) return false;
  bool found = false;
  for (const auto& entry : fs::directory_iterator(path)) {
    const std::string extension = lower_extension(entry.path());
    if (extension == ".tif" || extension == ".tiff" || extension == ".png") return false;
    found = found || (is_file(entry.path()) && has_mark(entry.path()));
  }
  return found;
}

Volume read_dicom(const fs::path& path, const ReadOptions& options) {
  dicom_library();  // before the process apart, which would load it again
  try_reading(path, options);
  return read_series(path, options);
}

VolumeFormat formats::dicom() {
  return {
      .name = "DICOM (a folder of slices, or a file of several frames)",
      .recognises = [](const fs::path& path, const ReadOptions&) { return is_dicom(path); },
      .files =
          [](const fs::path& path) { return is_folder(path) ? files_in(path) : std::vector<fs::path>{path}; },
      .read = read_dicom};
}

}  // namespace pendular
