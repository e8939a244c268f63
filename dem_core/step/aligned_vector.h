#pragma once

#include <cstddef>
#include <vector>

namespace pendular::dem_core {

/// Memory that begins on a cache line. Large pieces begin on a large page and ask for large pages where the
/// system has them: the tables of a step span more small pages than a core keeps addresses of.
void* allocate_aligned(std::size_t bytes);
void free_aligned(void* memory);

template <typename T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <typename U>
  AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t size) { return static_cast<T*>(allocate_aligned(size * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { free_aligned(memory); }
  bool operator==(const AlignedAllocator&) const { return true; }
};

template <typename T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace pendular::dem_core
