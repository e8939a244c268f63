#include "blind/split.h"
#include "fuzz.h"

/// A split file beside a sample that it may name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  static const fs::path sample = [] {
    Sample measured;
    measured.beads.diameters = Diameters::measured;
    return fuzz::put("s.toml", sample_text(measured));
  }();
  return fuzz::read_bytes(data, size, "split.toml",
                          [](const fs::path& path) { blind::read_split(path, std::nullopt); });
}
