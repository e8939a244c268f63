#include "fuzz.h"
#include "pipette/calibration.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pendular::fuzz::read_bytes(data, size, "c.toml", [](const pendular::fs::path& path) {
    pendular::pipette::read_calibration(path);
  });
}
