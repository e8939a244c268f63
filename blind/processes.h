#pragma once

#include <functional>
#include <vector>

#include "base/process.h"

namespace pendular::blind {

/// A process to be run, and the file that gets what it says.
struct Job {
  Command command;
  fs::path log;
};

/// Runs the jobs in order, `at_once` side by side. ended(k, status) is told each exit status, 128 + signal
/// where one was killed. Where the user stops the program the processes are stopped too, and Interrupted is
/// thrown.
void run_jobs(const std::vector<Job>& jobs, std::size_t at_once,
              const std::function<void(std::size_t k, int status)>& ended);

}  // namespace pendular::blind
