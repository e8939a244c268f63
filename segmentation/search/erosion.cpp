#include "segmentation/search/erosion.h"

namespace pendular::segmentation {
namespace {

void erode_line(std::uint8_t* first, std::size_t count, std::size_t reach) {
  std::size_t run = reach;
  for (std::size_t n = 0; n < count + reach; ++n) {
    run = n >= count || first[n] ? run + 1 : 0;
    if (n >= reach) first[n - reach] = run > 2 * reach;
  }
}

/// The same for `width` lines side by side, a row at a time.
void erode_rows(std::uint8_t* first, std::size_t width, std::size_t count, std::size_t reach) {
  std::vector<std::uint32_t> run(width, static_cast<std::uint32_t>(reach));
  const auto enough = static_cast<std::uint32_t>(2 * reach);
  for (std::size_t n = 0; n < count + reach; ++n) {
    const std::uint8_t* row = n < count ? first + n * width : nullptr;
    for (std::size_t i = 0; i < width; ++i) run[i] = !row || row[i] ? run[i] + 1 : 0;
    if (n < reach) continue;
    std::uint8_t* out = first + (n - reach) * width;
    for (std::size_t i = 0; i < width; ++i) out[i] = run[i] > enough;
  }
}

}  // namespace

void erode(Grid<std::uint8_t>& mask, std::size_t reach) {
  const auto [nx, ny, nz] = mask.size;
  for (std::size_t k = 0; k < nz; ++k) {
    std::uint8_t* const slice = mask.values.data() + k * nx * ny;
    for (std::size_t j = 0; j < ny; ++j) erode_line(slice + j * nx, nx, reach);
    erode_rows(slice, nx, ny, reach);
  }
  erode_rows(mask.values.data(), nx * ny, nz, reach);
}

}  // namespace pendular::segmentation
