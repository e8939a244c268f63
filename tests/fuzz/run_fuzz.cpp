#include "fuzz.h"
#include "run_folder/run_folder.h"

/// The tables and the result of a run folder.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  return fuzz::read_parts(data, size, {"curve.csv", "result.json", "events.csv"},
                          [](const fs::path& path) { read_run_curves(path.parent_path()); });
}
