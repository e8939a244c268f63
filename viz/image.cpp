#include "viz/image.h"

#include "base/error.h"
#include "viz/rendering.h"

namespace pendular::viz {

void write_png(const fs::path& path, const Image& image, const std::string& comment) {
  write_atomically(path, [&](const fs::path& temporary) {
    if (!rendering().write_png(temporary, image, comment))
      throw ComputationFailed(path.string() + ": cannot write the picture");
  });
}

}  // namespace pendular::viz
