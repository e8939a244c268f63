#include "blind/engine_run.h"
#include "blind/verdict.h"
#include "fuzz.h"

/// A diagnosis, a sealed truth, or what another program says of its test.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  if (size == 0) return 0;
  return fuzz::read_bytes(data + 1, size - 1, "v.json", [&](const fs::path& path) {
    if (data[0] % 3 == 0)
      blind::read_diagnosis(path);
    else if (data[0] % 3 == 1)
      blind::read_truth(path);
    else
      blind::read_result(path, 2, 1);
  });
}
