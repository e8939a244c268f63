#include "fuzz.h"
#include "sweep/plan.h"
#include "sweep/request.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  if (size == 0) return 0;
  static const fs::path sample = fuzz::put("s.toml", sample_text(Sample{}));
  return fuzz::read_bytes(data + 1, size - 1, "sweep.toml", [&](const fs::path& path) {
    if (data[0] % 2 == 0)
      sweep::read_sweep(path);
    else
      sweep::parse_request(std::string(fuzz::text_of(data + 1, size - 1)), "run");
  });
}
