#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/files.h"

namespace pendular::blind {

/// A process to be run: its words after the program's name, and the file that gets what it says.
struct Job {
  std::vector<std::string> words;
  fs::path log;
  fs::path program = {};  ///< empty: this one
};

/// Runs a program once for each job, `at_once` side by side, in order. ended(k, status) is told each
/// exit status, 128 + signal where one was killed. Where the user stops the program the processes are stopped
/// too, and Interrupted is thrown; they go where this process is killed.
void run_jobs(const std::vector<Job>& jobs, std::size_t at_once,
              const std::function<void(std::size_t k, int status)>& ended);

/// The last line that a process wrote to its log, for messages.
std::string last_line(const fs::path& log);

}  // namespace pendular::blind
