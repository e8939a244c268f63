#include <vtkImageData.h>
#include <vtkJPEGWriter.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkUnsignedCharArray.h>
#include <zlib.h>

#include <algorithm>

#include "base/error.h"
#include "viz/vtk/pictures.h"

namespace pendular::viz {
namespace {

constexpr int kQuality = 85;

/// For each pixel of a shorter row: the first pixel of the longer one that falls into it, and the one after
/// the last.
std::pair<int, int> span_of(int pixel, int shorter, int longer) {
  const auto edge = [&](int k) { return static_cast<int>(static_cast<std::int64_t>(k) * longer / shorter); };
  return {edge(pixel), std::max(edge(pixel) + 1, edge(pixel + 1))};
}

std::size_t big_endian(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t k = at; k < at + 4; ++k) value = 256 * value + static_cast<unsigned char>(bytes[k]);
  return value;
}

/// Whether every chunk of a PNG file is there with its checksum: VTK's reader does not survive a cut one.
bool is_whole_png(const std::string& bytes) {
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  if (!bytes.starts_with(signature)) return false;
  for (std::size_t at = signature.size(); at + 12 <= bytes.size();) {
    const std::size_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - 12) return false;
    const auto* typed = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
    if (crc32(0, typed, static_cast<uInt>(length + 4)) != big_endian(bytes, at + 8 + length)) return false;
    if (bytes.compare(at + 4, 4, "IEND") == 0) return true;
    at += 12 + length;
  }
  return false;
}

vtkSmartPointer<vtkImageData> read_png(const fs::path& path) {
  require_readable(path);
  if (!is_whole_png(read_text(path)))
    bad_input("{}: found no PNG picture, or a damaged one, expected a whole one", path.string());
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || image->GetNumberOfPoints() == 0)
    bad_input("{}: found a damaged PNG picture, expected a whole one", path.string());
  if (image->GetScalarType() != VTK_UNSIGNED_CHAR)
    bad_input("{}: found a PNG picture of other than 8 bits per channel, expected such", path.string());
  return image;
}

/// As a screen shows it on white: grey as three equal channels, no transparency.
vtkSmartPointer<vtkImageData> shrunk(vtkImageData& full, int most) {
  const int* size = full.GetDimensions();
  const int width = std::min(most, size[0]);
  const int height = std::max(1, static_cast<int>(static_cast<std::int64_t>(size[1]) * width / size[0]));
  const int channels = full.GetNumberOfScalarComponents();
  const auto* pixels = static_cast<const std::uint8_t*>(full.GetScalarPointer());
  auto small = vtkSmartPointer<vtkImageData>::New();
  small->SetDimensions(width, height, 1);
  small->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<std::uint8_t*>(small->GetScalarPointer());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto [left, right] = span_of(x, width, size[0]);
      const auto [low, high] = span_of(y, height, size[1]);
      std::array<int, 3> sum{};
      for (int v = low; v < high; ++v)
        for (int u = left; u < right; ++u) {
          const std::uint8_t* at = pixels + (static_cast<std::ptrdiff_t>(v) * size[0] + u) * channels;
          const int cover = channels % 2 == 0 ? at[channels - 1] : 255;
          for (int c = 0; c < 3; ++c)
            sum[static_cast<std::size_t>(c)] +=
                (at[channels < 3 ? 0 : c] * cover + 255 * (255 - cover)) / 255;
        }
      const int count = (right - left) * (high - low);
      for (const int channel : sum) *out++ = static_cast<std::uint8_t>((channel + count / 2) / count);
    }
  return small;
}

}  // namespace

std::string jpeg_thumbnail(const fs::path& picture, int width) {
  const auto full = read_png(picture);
  vtkNew<vtkJPEGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetQuality(kQuality);
  writer->SetInputData(shrunk(*full, width));
  writer->Write();
  auto* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace pendular::viz
