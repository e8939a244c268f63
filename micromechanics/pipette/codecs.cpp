#include "pipette/codecs.h"

#include "base/error.h"
#include "base/files.h"
#include "base/module.h"

namespace pendular::pipette {

const Codecs& codecs() {
  static const auto* found =
      static_cast<const Codecs*>(module_symbol(PENDULAR_IMAGE_CODECS, "pendular_image_codecs"));
  return *found;
}

void write_picture(const std::string& path, const cv::Mat& picture) {
  write_atomically(path, [&](const fs::path& temporary) {
    if (!codecs().write(temporary.string(), picture))
      throw ComputationFailed(fmt::format("{}: cannot be written", path));
  });
}

}  // namespace pendular::pipette
