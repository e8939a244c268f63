#include "dem_core/step/aligned_vector.h"

#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pendular::dem_core {
namespace {

constexpr std::size_t kCacheLine = 64, kLargePage = std::size_t{1} << 21;

std::size_t rounded_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  const std::size_t unit = bytes >= kLargePage / 4 ? kLargePage : kCacheLine;
  void* memory = std::aligned_alloc(unit, rounded_up(bytes, unit));
  if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
  if (unit == kLargePage)
    madvise(memory, rounded_up(bytes, unit), MADV_HUGEPAGE);  // a wish; refusal does no harm
#endif
  return memory;
}

void free_aligned(void* memory) {
  std::free(memory);
}

}  // namespace pendular::dem_core
