#include "diagnosis/experiment/experiment.h"
#include "fuzz.h"

/// An experiment file, a table of observations and one of beads.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  static const fs::path sample = fuzz::put("s.toml", sample_text(Sample{}));
  return fuzz::read_parts(data, size, {"e.toml", "t.csv", "b.csv"}, [](const fs::path& path) {
    diagnosis::read_beliefs(path);
    diagnosis::read_experiment(path);
  });
}
