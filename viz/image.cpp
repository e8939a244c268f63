#include "viz/image.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>

#include <algorithm>

#include "base/error.h"

namespace pendular::viz {

void write_png(const fs::path& path, const Image& image, const std::string& comment) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(image.width);
  auto* pixels = static_cast<std::uint8_t*>(data->GetScalarPointer());
  for (int y = 0; y < image.height; ++y)  // VTK counts rows from the bottom
    std::copy_n(image.rgb.begin() + y * row, row, pixels + (image.height - 1 - y) * row);
  write_atomically(path, [&](const fs::path& temporary) {
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputData(data);
    if (!comment.empty()) writer->AddText("Comment", comment.c_str());
    writer->SetFileName(temporary.c_str());
    writer->Write();
    if (writer->GetErrorCode() != 0) throw ComputationFailed(path.string() + ": cannot write the picture");
  });
}

}  // namespace pendular::viz
