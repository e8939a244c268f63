#pragma once

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace pendular::dem_core {

/// While it lives, this thread takes denormal numbers for zero. Ahead of an elastic wave the motion is
/// denormal numbers, a hundred times slower to add.
class FlushDenormals {
#ifdef __SSE2__
 public:
  FlushDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | 0x8040);
  }
  ~FlushDenormals() {
    _mm_setcsr(before_);
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
#endif
};

}  // namespace pendular::dem_core
