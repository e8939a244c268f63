#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "sweep/executors.h"

namespace pendular::sweep {
namespace {

using Clock = std::chrono::steady_clock;

/// Runs made by child processes, which go when this process does.
class Children {
 public:
  Children(Store& store, const fs::path& program) : store_(store), program_(program) {}
  ~Children() { stop(); }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  std::size_t count() const { return hash_of_.size(); }

  bool makes(const std::string& hash) const {
    return std::any_of(hash_of_.begin(), hash_of_.end(),
                       [&](const auto& item) { return item.second == hash; });
  }

  void start(const std::string& hash, std::size_t threads) {
    const std::string store = fs::absolute(store_.folder()).string(), count = std::to_string(threads);
    const std::string program = program_.string(), log = store_.log_path(hash).string();
    const char* const words[] = {"pendular",  "sweep-run",   store.c_str(), hash.c_str(),
                                 "--threads", count.c_str(), nullptr};
    const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (output < 0)
      throw ComputationFailed(fmt::format("{}: cannot be written: {}", log, std::strerror(errno)));
    const pid_t parent = ::getpid(), child = ::fork();
    if (child == 0) become(program.c_str(), words, output, parent);
    const int why = errno;
    ::close(output);
    if (child < 0) throw ComputationFailed(fmt::format("no process can be started: {}", std::strerror(why)));
    hash_of_[child] = hash;
  }

  /// Whether one has ended. What it has not told the store itself is told for it.
  bool one_ended() {
    int status = 0;
    for (auto child = hash_of_.begin(); child != hash_of_.end(); ++child) {
      if (::waitpid(child->first, &status, WNOHANG) != child->first) continue;
      const std::string hash = child->second;
      hash_of_.erase(child);
      book_end(hash, status);
      return true;
    }
    return false;
  }

  /// Lets all keep their checkpoints and end.
  void stop() {
    for (const auto& [child, hash] : hash_of_) ::kill(child, SIGINT);
    for (const auto& [child, hash] : hash_of_) ::waitpid(child, nullptr, 0);
    hash_of_.clear();
  }

 private:
  /// In the new process, where only calls safe after fork are allowed.
  [[noreturn]] static void become(const char* program, const char* const* words, int output, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(130);  // it went before it could be watched
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execv(program, const_cast<char* const*>(words));
    ::_exit(127);
  }

  void book_end(const std::string& hash, int status) {
    const RunRecord record = store_.record(hash);
    if (!record.free()) return;
    const std::string words = last_words(store_, hash);
    if (WIFSIGNALED(status))
      store_.fail(
          hash, 128 + WTERMSIG(status),
          fmt::format("its process was killed by signal {} ({}){}", WTERMSIG(status),
                      ::strsignal(WTERMSIG(status)), words.empty() ? "" : "; it last said: " + words));
    else if (WEXITSTATUS(status) == 127)
      throw ComputationFailed(fmt::format("{}: cannot be started", program_.string()));  // the run stays open
    else if (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != 130)
      store_.fail(hash, WEXITSTATUS(status), words);
  }

  Store& store_;
  fs::path program_;
  std::map<pid_t, std::string> hash_of_;
};

}  // namespace

void run_locally(Store& store, OpenRuns& open, const ExecuteOptions& options) {
  const std::size_t cores = options.cores > 0 ? static_cast<std::size_t>(options.cores) : thread_count();
  Children children(store, options.program);
  auto asked = Clock::now();
  while (!open.records().empty()) {
    const std::size_t at_once = std::min(cores, open.records().size());
    for (const auto& record : open.records())
      if (children.count() < at_once && record.free() && !children.makes(record.hash))
        children.start(record.hash, cores / at_once);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (interrupted()) {
      children.stop();
      throw Interrupted("interrupted; the same command goes on where it stopped");
    }
    // Runs that other processes make end without a sign to this one.
    if (!children.one_ended() && Clock::now() - asked < std::chrono::milliseconds(500)) continue;
    asked = Clock::now();
    open.ask();
  }
}

}  // namespace pendular::sweep
