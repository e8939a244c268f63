#include "base/text_line.h"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string line = pendular::text_line({reinterpret_cast<const char*>(data), size});
  if (line.size() > 610 || line != pendular::text_line(line)) std::abort();
  return 0;
}
