#pragma once

#include <algorithm>
#include <string>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"

namespace pendular {

/// Calls body(n) for all n < size in parallel, `batch` of them at a time; between batches it tells how far
/// `what` has come, and stops if the user wants it to.
template <typename Body>
void for_batches(const std::string& what, std::size_t size, std::size_t batch, const Body& body) {
  Progress progress(what, static_cast<double>(size));
  for (std::size_t first = 0; first < size; first += batch) {
    stop_if_interrupted();
    const std::size_t last = std::min(size, first + batch);
    for_blocks(last - first, 1, [&](std::size_t n, std::size_t) { body(first + n); });
    progress.update(static_cast<double>(last));
  }
}

}  // namespace pendular
