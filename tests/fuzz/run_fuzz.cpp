#include "fuzz.h"
#include "viz/run_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  if (size == 0) return 0;
  static const bool whole = [] {
    write_text(fuzz::folder() / "curve.csv", "strain,stress_pa\n0,0\n0.01,1e5\n");
    write_text(fuzz::folder() / "result.json", "{}\n");
    return true;
  }();
  const bool curve = data[0] % 2 == 0 && whole;
  fuzz::read_bytes(data + 1, size - 1, curve ? "curve.csv" : "result.json",
                   [](const fs::path& path) { viz::read_run_curves(path.parent_path()); });
  write_text(fuzz::folder() / "result.json", "{}\n");
  return 0;
}
