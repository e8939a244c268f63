#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <cstddef>

#ifdef __SANITIZE_THREAD__
#define PENDULAR_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PENDULAR_THREAD_SANITIZER
#endif
#endif
#ifdef PENDULAR_THREAD_SANITIZER
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#endif

namespace pendular {

/// Tells the thread sanitizer, which does not see into the TBB library, that a loop's parts start after what
/// stands before the loop and end before what follows it; that its parts have no order is left to be seen.
class LoopOrder {
 public:
#ifdef PENDULAR_THREAD_SANITIZER
  LoopOrder() {
    __tsan_release(&start_);
  }
  ~LoopOrder() {
    __tsan_acquire(&end_);
  }
  void part_starts() {
    __tsan_acquire(&start_);
  }
  void part_ends() {
    __tsan_release(&end_);
  }

 private:
  char start_ = 0, end_ = 0;
#else
  void part_starts() {}
  void part_ends() {}
#endif
};

/// Limits every parallel loop of the program to `threads` (0: one per core). Call once, from main.
void set_threads(int threads);

/// Threads that a parallel loop may use.
std::size_t thread_count();

/// Calls body(first, last) over [0, size) cut into blocks of `block`. The blocks do not depend on the
/// number of threads, so a sum kept per block and added in order of blocks is bitwise the same for any.
template <typename Body>
void for_blocks(std::size_t size, std::size_t block, const Body& body) {
  const std::size_t blocks = (size + block - 1) / block;
  LoopOrder order;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, blocks),
      [&](const tbb::blocked_range<std::size_t>& range) {
        order.part_starts();
        for (std::size_t b = range.begin(); b != range.end(); ++b)
          body(b * block, b * block + block < size ? b * block + block : size);
        order.part_ends();
      },
      tbb::auto_partitioner());
}

/// Calls body(share) for all share < shares, of which there is about one per thread: each on a thread of its
/// own as far as one is free, and on the same one when such a loop is run again, as its cache still holds the
/// data.
template <typename Body>
void for_shares(std::size_t shares, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, shares),
      [&](const tbb::blocked_range<std::size_t>& range) {
        order.part_starts();
        for (std::size_t share = range.begin(); share != range.end(); ++share) body(share);
        order.part_ends();
      },
      tbb::static_partitioner());
}

}  // namespace pendular
