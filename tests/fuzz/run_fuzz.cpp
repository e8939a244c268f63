#include "fuzz.h"
#include "run_folder/run_folder.h"

/// A curve beside a good result, or a result beside a good curve.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  if (size == 0) return 0;
  static const bool whole = [] {
    for (const char* run : {"a", "b"}) {
      make_folder(fuzz::folder() / run);
      write_text(fuzz::folder() / run / "curve.csv", "strain,stress_pa\n0,0\n0.01,1e5\n");
      write_text(fuzz::folder() / run / "result.json", "{}\n");
    }
    return true;
  }();
  const bool curve = data[0] % 2 == 0 && whole;
  return fuzz::read_bytes(data + 1, size - 1, curve ? "a/curve.csv" : "b/result.json",
                          [](const fs::path& path) { read_run_curves(path.parent_path()); });
}
