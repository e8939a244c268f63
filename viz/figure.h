#pragma once

#include <string>

#include "viz/image.h"

namespace pendular::viz {

/// A chart as text: what gnuplot draws, without a word on the format (but `point`, the size of a marker with
/// a radius of a pixel). Texts in it are quoted, so that no label can be a command.
struct Figure {
  PictureSize size;  ///< pixels as PNG; half as many points as PDF
  std::string script;
};

}  // namespace pendular::viz
