#pragma once

#include <cstdint>
#include <string>

namespace pendular::sweep {

/// A process, told apart from all others of a cluster: host, process number, and when it started.
struct WorkerId {
  std::string host;
  std::int64_t pid = 0;
  std::int64_t started = 0;  ///< clock ticks after the host did
};

WorkerId this_worker();

/// Whether a process still runs: known on this host; on another, one that gave a sign of life less than five
/// minutes ago counts as running.
bool alive(const WorkerId& worker, double seconds_since_sign);

}  // namespace pendular::sweep
