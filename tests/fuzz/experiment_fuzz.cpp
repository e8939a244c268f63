#include "diagnosis/experiment/experiment.h"
#include "fuzz.h"

/// An experiment file, a table of observations and one of beads. Without single bridges: their table is held
/// against finite elements, which take a minute under sanitizers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  if (fuzz::text_of(data, size).find("bridge_stiffness") != std::string_view::npos) return -1;
  static const fs::path sample = fuzz::put("s.toml", sample_text(Sample{}));
  return fuzz::read_parts(data, size, {"e.toml", "t.csv", "b.csv"}, [](const fs::path& path) {
    diagnosis::read_beliefs(path);
    diagnosis::read_experiment(path);
  });
}
