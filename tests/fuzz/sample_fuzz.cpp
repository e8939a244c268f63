#include "base/sample.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pendular::fuzz::read_bytes(data, size, "s.toml", [](const pendular::fs::path& path) {
    const std::string text = pendular::read_text(path);
    pendular::whole_sample(text, path.string());
  });
}
