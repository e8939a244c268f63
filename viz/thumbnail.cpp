#include "viz/thumbnail.h"

#include "viz/rendering.h"

namespace pendular::viz {

std::string thumbnail(const fs::path& picture, int width) {
  return rendering().thumbnail(picture, width);
}

}  // namespace pendular::viz
