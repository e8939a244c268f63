#include "fuzz.h"
#include "packing/tables.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pendular::fuzz::read_bytes(data, size, "b.csv",
                                    [](const pendular::fs::path& path) { pendular::read_beads(path); });
}
