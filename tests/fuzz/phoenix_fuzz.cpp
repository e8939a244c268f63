#include "fuzz.h"
#include "volume/phoenix.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pendular::fuzz::read_bytes(data, size, "v.pcr",
                                    [](const pendular::fs::path& path) { pendular::read_pcr(path); });
}
