#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "viz/display.h"
#include "viz/image.h"

namespace pendular::viz {

/// A number for every bead of a specimen.
struct BeadMap {
  std::string title, quantity;            ///< what stands above the picture, and above the colour bar
  std::string note;                       ///< a line under the title
  std::vector<Vec3> centres;              ///< m
  std::vector<double> diameters, values;  ///< m; NaN is drawn grey
  double low = 0.0, high = 1.0;           ///< ends of the colours
  bool is_signed = false;                 ///< blue over white to red, for ranges about zero
};

/// Of each, the half of the specimen behind the vertical plane through its axis, seen along y.
std::vector<Image> draw_bead_maps(const Display& display, std::span<const BeadMap> maps,
                                  PictureSize size = {});

}  // namespace pendular::viz
