// The reader of tables (fast-cpp-csv-parser) takes a block of 48 MiB for each file. Under the address
// sanitizer, to map it and give it back takes hundreds of times as long as to read a table of a fuzzer's
// size; so one such block is kept. While nobody has it, its beginning, where the file lay, is poisoned.

#include <sanitizer/allocator_interface.h>
#include <sanitizer/asan_interface.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t kBlock = 3U << 24U, kBeginning = 1U << 16U;
std::atomic<void*> kept{nullptr};

}  // namespace

void* operator new[](std::size_t size) {
  void* block = size == kBlock ? kept.exchange(nullptr) : nullptr;
  if (block) {
    ASAN_UNPOISON_MEMORY_REGION(block, kBeginning);
    return block;
  }
  block = std::malloc(size > 0 ? size : 1);
  if (!block) throw std::bad_alloc();
  return block;
}

void operator delete[](void* block) noexcept {
  if (block && __sanitizer_get_allocated_size(block) == kBlock) {
    ASAN_POISON_MEMORY_REGION(block, kBeginning);
    block = kept.exchange(block);
    if (block) ASAN_UNPOISON_MEMORY_REGION(block, kBeginning);
  }
  std::free(block);
}

void operator delete[](void* block, std::size_t) noexcept {
  operator delete[](block);
}
