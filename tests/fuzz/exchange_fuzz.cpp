#include "fuzz.h"
#include "packing/exchange.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using pendular::ExchangeFormat;
  constexpr ExchangeFormat formats[] = {ExchangeFormat::yade, ExchangeFormat::lammps,
                                        ExchangeFormat::liggghts, ExchangeFormat::xyz};
  if (size == 0) return 0;
  return pendular::fuzz::read_bytes(data + 1, size - 1, "x", [&](const pendular::fs::path& path) {
    pendular::read_exchange(path, formats[data[0] % 4], 2e-4);
  });
}
