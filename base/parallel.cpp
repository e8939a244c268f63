#include "base/parallel.h"

#include <tbb/global_control.h>

#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

namespace pendular {

void set_threads(int threads) {
  static std::unique_ptr<tbb::global_control> limit;
  limit.reset();
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
}

std::size_t thread_count() {
  const auto limit = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(limit, static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
}

}  // namespace pendular
