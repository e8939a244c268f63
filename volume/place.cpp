#include "volume/place.h"

#include <algorithm>
#include <cmath>

#include "base/columns.h"
#include "base/error.h"
#include "base/progress.h"
#include "volume/resample.h"

namespace pendular {

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

void check_place(const Volume& volume, const fs::path& path) {
  constexpr Range voxel{1e-3, 1e4};  // um
  require_in_range(path.string(), "voxel size, um", voxel, 1e6 * volume.spacing);
  for (int axis = 0; axis < 3; ++axis)
    require_in_range(path.string(), "origin, um", range_of("x_um"), 1e6 * volume.origin[axis]);
}

std::array<double, 3> place(Volume& volume, const Placement* header, const fs::path& path,
                            const ReadOptions& options) {
  std::optional<double> spacing = options.spacing;
  std::array<double, 3> edges{1.0, 1.0, 1.0};
  if (header) {
    if (!options.spacing) edges = over_shortest(header->spacing, path);
    const double shortest = *std::min_element(header->spacing.begin(), header->spacing.end());
    const bool stated = shortest != 1.0 || edges != std::array{1.0, 1.0, 1.0};
    if (!spacing && stated) spacing = shortest * header->unit;
    for (std::size_t axis = 0; axis < 3; ++axis)  // an offset in voxels follows an overriding voxel size
      volume.origin[static_cast<Eigen::Index>(axis)] = stated && spacing
                                                           ? header->origin[axis] / shortest * *spacing
                                                           : header->origin[axis] * header->unit;
  }
  if (!spacing)
    warn(fmt::format(
        "{}: no voxel size in the file and no --voxel-um: taken as 1 um, so lengths are in voxels",
        path.string()));
  volume.spacing = spacing.value_or(1e-6);
  check_place(volume, path);
  return edges;
}

}  // namespace pendular
