#include "fuzz.h"
#include "packing/tables.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<pendular::Bead> beads = [] {
    std::vector<pendular::Bead> made(4);
    for (std::size_t k = 0; k < made.size(); ++k) {
      made[k].id = static_cast<std::int64_t>(k) + 1;
      made[k].centre = {0.0, 0.0, 205e-6 * static_cast<double>(k)};
      made[k].diameter = 200e-6;
    }
    return made;
  }();
  return pendular::fuzz::read_bytes(
      data, size, "g.csv", [](const pendular::fs::path& path) { pendular::read_bridges(path, beads); });
}
