#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>

#include <algorithm>

#include "viz/vtk/pictures.h"

namespace pendular::viz {

bool write_png_file(const fs::path& path, const Image& image, const std::string& comment) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(image.width);
  auto* pixels = static_cast<std::uint8_t*>(data->GetScalarPointer());
  for (int y = 0; y < image.height; ++y)  // VTK counts rows from the bottom
    std::copy_n(image.rgb.begin() + y * row, row, pixels + (image.height - 1 - y) * row);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(data);
  if (!comment.empty()) writer->AddText("Comment", comment.c_str());
  writer->SetFileName(path.c_str());
  writer->Write();
  return writer->GetErrorCode() == 0;
}

}  // namespace pendular::viz
