#include "viz/bead_map.h"

#include "base/own_process.h"
#include "viz/rendering.h"

namespace pendular::viz {

std::vector<Image> draw_bead_maps(const Display& display, std::span<const BeadMap> maps, PictureSize size) {
  const auto connection = display.connect();
  const SilentStandardError silent;
  return rendering().draw_bead_maps(connection.get(), maps, size);
}

}  // namespace pendular::viz
