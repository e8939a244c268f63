#include "blind/processes.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"

namespace pendular::blind {
namespace {

constexpr const char* kSelf = "/proc/self/exe";

/// In the new process, where only calls safe after fork are allowed.
[[noreturn]] void become(const char* program, char* const* words, int output, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(130);  // it went before it could be watched
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execv(program, words);
  ::_exit(127);
}

pid_t start(const Job& job) {
  std::vector<std::string> words = job.words;
  words.insert(words.begin(), job.program.empty() ? "pendular" : job.program.string());
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int output = ::open(job.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output < 0)
    throw ComputationFailed(fmt::format("{}: cannot be written: {}", job.log.string(), std::strerror(errno)));
  const std::string program = job.program.empty() ? kSelf : job.program.string();
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0) become(program.c_str(), pointers.data(), output, parent);
  const int why = errno;
  ::close(output);
  if (child < 0) throw ComputationFailed(fmt::format("no process can be started: {}", std::strerror(why)));
  return child;
}

/// The processes that run, stopped where they are left.
struct Running {
  std::map<pid_t, std::size_t> job;
  ~Running() {
    for (const auto& [child, k] : job) ::kill(child, SIGINT);
    for (const auto& [child, k] : job) ::waitpid(child, nullptr, 0);
  }
};

}  // namespace

void run_jobs(const std::vector<Job>& jobs, std::size_t at_once,
              const std::function<void(std::size_t k, int status)>& ended) {
  Running running;
  std::size_t next = 0;
  while (next < jobs.size() || !running.job.empty()) {
    for (; next < jobs.size() && running.job.size() < at_once; ++next) running.job[start(jobs[next])] = next;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (interrupted()) throw Interrupted("interrupted; the same command goes on where it stopped");
    for (auto child = running.job.begin(); child != running.job.end();) {
      int status = 0;
      if (::waitpid(child->first, &status, WNOHANG) != child->first) {
        ++child;
        continue;
      }
      const std::size_t k = child->second;
      child = running.job.erase(child);
      ended(k, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    }
  }
}

std::string last_line(const fs::path& log) {
  if (!fs::exists(log)) return "";
  std::string text = read_text(log);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace pendular::blind
