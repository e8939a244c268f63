#include "segmentation/itk_images.h"

#include <itkImportImageFilter.h>
#include <itkMultiThreaderBase.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>
#include <itkSmoothingRecursiveGaussianImageFilter.h>

#include "base/error.h"
#include "base/parallel.h"
#include "segmentation/grid.h"

namespace pendular {
namespace {

using FloatImage = itk::Image<float, 3>;

/// The grid as an ITK image on the same memory.
template <typename T>
auto itk_image(const Grid<T>& grid) {
  auto import = itk::ImportImageFilter<T, 3>::New();
  typename itk::ImportImageFilter<T, 3>::RegionType region;
  for (unsigned axis = 0; axis < 3; ++axis) region.SetSize(axis, grid.size[axis]);
  import->SetRegion(region);
  import->SetImportPointer(const_cast<T*>(grid.values.data()), grid.values.size(),
                           false);  // ITK only reads it
  return import;
}

template <typename Filter, typename T>
Grid<float> filtered(Filter& filter, const Grid<T>& grid) {
  const auto image = itk_image(grid);
  filter.SetInput(image->GetOutput());
  try {
    filter.Update();
  } catch (const itk::ExceptionObject& error) {
    throw ComputationFailed(fmt::format("image filter: {}", error.GetDescription()));
  }
  const float* out = filter.GetOutput()->GetBufferPointer();
  return {grid.size, grid.factor, std::vector<float>(out, out + grid.values.size())};
}

}  // namespace

Grid<float> binned(const Volume& volume, std::size_t factor) {
  Grid<float> grid;
  grid.factor = factor;
  for (int axis = 0; axis < 3; ++axis) grid.size[axis] = volume.size[axis] / factor;
  grid.values.resize(grid.size[0] * grid.size[1] * grid.size[2]);
  const double share = 1.0 / static_cast<double>(factor * factor * factor);
  with_pixels(volume, [&](auto pixels) {
    for_blocks(grid.size[2], 1, [&](std::size_t k, std::size_t) {
      std::vector<double> row(grid.size[0]);
      for (std::size_t j = 0; j < grid.size[1]; ++j) {
        std::fill(row.begin(), row.end(), 0.0);
        for (std::size_t z = k * factor; z < (k + 1) * factor; ++z)
          for (std::size_t y = j * factor; y < (j + 1) * factor; ++y) {
            const auto* source = pixels.data() + (z * volume.size[1] + y) * volume.size[0];
            for (std::size_t i = 0; i < grid.size[0]; ++i)
              for (std::size_t x = 0; x < factor; ++x) row[i] += static_cast<double>(*source++);
          }
        for (std::size_t i = 0; i < grid.size[0]; ++i)
          grid.values[grid.index(i, j, k)] = static_cast<float>(row[i] * share);
      }
    });
  });
  return grid;
}

Grid<float> smoothed(const Grid<float>& grid, double sd) {
  for (const std::size_t n : grid.size)
    if (n < 4) return grid;  // the recursive filter needs four nodes along each axis
  auto filter = itk::SmoothingRecursiveGaussianImageFilter<FloatImage, FloatImage>::New();
  filter->SetSigma(sd);
  return filtered(*filter, grid);
}

Grid<float> distance_inside(const Grid<std::uint8_t>& mask) {
  auto filter = itk::SignedMaurerDistanceMapImageFilter<itk::Image<std::uint8_t, 3>, FloatImage>::New();
  filter->SetSquaredDistance(false);
  filter->SetUseImageSpacing(false);
  filter->SetInsideIsPositive(true);
  Grid<float> distance = filtered(*filter, mask);
  // The map counts from the centres of the mask's outermost nodes, half a node within its surface.
  for (std::size_t n = 0; n < mask.values.size(); ++n)
    distance.values[n] = mask.values[n] ? std::abs(distance.values[n]) + 0.5f : 0.0f;
  return distance;
}

}  // namespace pendular
