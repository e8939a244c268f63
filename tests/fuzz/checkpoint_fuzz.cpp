#include "dem_core/checkpoint.h"
#include "fuzz.h"

namespace {

constexpr char kIdentity[] = "of this work";

/// What stands before the checksum of a good checkpoint.
const std::string& head() {
  static const std::string text = [] {
    const pendular::fs::path good = pendular::fuzz::folder() / "good";
    pendular::dem_core::write_checkpoint(good, {}, kIdentity);
    const std::string whole = pendular::read_text(good);
    return whole.substr(0, whole.find(kIdentity) + sizeof kIdentity);
  }();
  return text;
}

}  // namespace

/// Bytes under a checksum that is right, or the file itself.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pendular;
  if (size == 0) return 0;
  std::string bytes(fuzz::text_of(data + 1, size - 1));
  if (data[0] % 8 != 0) bytes = head() + sha256(bytes) + "\n" + bytes;
  const fs::path path = fuzz::put("checkpoint", bytes);
  return fuzz::read_quietly([&] { dem_core::read_checkpoint(path, kIdentity); });
}
