#include "fuzz.h"
#include "packing/vtp.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pendular::fuzz::read_bytes(data, size, "p.vtp",
                                    [](const pendular::fs::path& path) { pendular::read_packing(path); });
}
