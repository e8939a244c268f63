#include "volume/itk_images.h"

#include <itkImportImageFilter.h>
#include <itkMultiThreaderBase.h>
#include <itkSmoothingRecursiveGaussianImageFilter.h>

#include "base/error.h"
#include "base/parallel.h"
#include "segmentation/search/grid.h"

namespace pendular::segmentation {
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
  filter.SetNumberOfWorkUnits(1);  // slabs go to threads, not their parts
  try {
    filter.Update();
  } catch (const itk::ExceptionObject& error) {
    throw ComputationFailed(fmt::format("image filter: {}", error.GetDescription()));
  }
  const float* out = filter.GetOutput()->GetBufferPointer();
  return {grid.size, grid.factor, std::vector<float>(out, out + grid.values.size())};
}

/// Means over blocks of factor³ voxels, of the nodes' slices [first, last).
template <typename T>
Grid<float> binned(std::span<const Grey<T>> pixels, const std::array<std::size_t, 3>& size,
                   std::size_t factor, std::size_t first, std::size_t last) {
  Grid<float> grid{{size[0] / factor, size[1] / factor, last - first}, static_cast<double>(factor), {}};
  grid.values.reserve(grid.size[0] * grid.size[1] * grid.size[2]);
  const double share = 1.0 / static_cast<double>(factor * factor * factor);
  std::vector<double> row(grid.size[0]);
  for (std::size_t k = first; k < last; ++k)
    for (std::size_t j = 0; j < grid.size[1]; ++j) {
      std::fill(row.begin(), row.end(), 0.0);
      for (std::size_t z = k * factor; z < (k + 1) * factor; ++z)
        for (std::size_t y = j * factor; y < (j + 1) * factor; ++y) {
          const auto* source = pixels.data() + (z * size[1] + y) * size[0];
          for (double& sum : row)
            for (std::size_t x = 0; x < factor; ++x) sum += static_cast<double>(*source++);
        }
      for (const double sum : row) grid.values.push_back(static_cast<float>(sum * share));
    }
  return grid;
}

Grid<float> smoothed(const Grid<float>& grid, double sd) {
  for (const std::size_t n : grid.size)
    if (n < 4) return grid;  // the recursive filter needs four nodes along each axis
  auto filter = itk::SmoothingRecursiveGaussianImageFilter<FloatImage, FloatImage>::New();
  filter->SetSigma(sd);
  return filtered(*filter, grid);
}

}  // namespace

Grid<float> reduced(const Volume& volume, std::size_t factor, double sd) {
  constexpr std::size_t thickness = 32;
  const auto margin = static_cast<std::size_t>(std::ceil(8.0 * sd));  // what lies beyond has no weight
  Grid<float> grid{{volume.size[0] / factor, volume.size[1] / factor, volume.size[2] / factor},
                   static_cast<double>(factor),
                   {}};
  const std::size_t slice = grid.size[0] * grid.size[1];
  grid.values.resize(slice * grid.size[2]);
  with_pixels(volume, [&](auto pixels) {
    for_blocks(grid.size[2], thickness, [&](std::size_t first, std::size_t last) {
      const std::size_t from = first - std::min(first, margin), to = std::min(grid.size[2], last + margin);
      const Grid<float> slab = smoothed(binned(pixels, volume.size, factor, from, to), sd);
      const auto core = slab.values.begin() + static_cast<std::ptrdiff_t>((first - from) * slice);
      std::copy_n(core, (last - first) * slice,
                  grid.values.begin() + static_cast<std::ptrdiff_t>(first * slice));
    });
  });
  return grid;
}

}  // namespace pendular::segmentation
