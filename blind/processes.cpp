#include "blind/processes.h"

#include <chrono>
#include <map>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"

namespace pendular::blind {
namespace {

/// The processes that run, by the job's place; all are asked to end where they are left, before one is waited
/// for.
struct Running {
  std::map<std::size_t, Process> job;
  ~Running() {
    for (const auto& [k, process] : job) process.ask_to_end();
  }
};

}  // namespace

void run_jobs(const std::vector<Job>& jobs, std::size_t at_once,
              const std::function<void(std::size_t k, int status)>& ended) {
  Running running;
  std::size_t next = 0;
  while (next < jobs.size() || !running.job.empty()) {
    for (; next < jobs.size() && running.job.size() < at_once; ++next)
      running.job.emplace(next, Process(jobs[next].command, {.log = jobs[next].log}));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (interrupted()) throw Interrupted("interrupted; the same command goes on where it stopped");
    for (auto one = running.job.begin(); one != running.job.end();) {
      const auto status = one->second.ended();
      if (!status) {
        ++one;
        continue;
      }
      const std::size_t k = one->first;
      one = running.job.erase(one);
      ended(k, *status);
    }
  }
}

}  // namespace pendular::blind
