#include <algorithm>
#include <chrono>
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
  Children(Store& store, const Command& worker) : store_(store), worker_(worker) {}
  ~Children() { stop(); }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  std::size_t count() const { return child_of_.size(); }

  bool makes(const std::string& hash) const { return child_of_.contains(hash); }

  void start(const std::string& hash, std::size_t threads) {
    const std::string store = fs::absolute(store_.folder()).string();
    child_of_.emplace(hash, Process(worker_.with({store, hash, "--threads", std::to_string(threads)}),
                                    {.log = store_.log_path(hash)}));
  }

  /// Whether one has ended. What it has not told the store itself is told for it.
  bool one_ended() {
    for (auto& [name, child] : child_of_) {
      const auto status = child.ended();
      if (!status) continue;
      const std::string hash = name;
      child_of_.erase(hash);
      book_end(hash, *status);
      return true;
    }
    return false;
  }

  /// Lets all keep their checkpoints and end.
  void stop() {
    for (const auto& [hash, child] : child_of_) child.ask_to_end();
    child_of_.clear();
  }

 private:
  void book_end(const std::string& hash, int status) {
    constexpr int kKilled = 128, kInterrupted = 130;
    const RunRecord record = store_.record(hash);
    if (!record.free()) return;
    const std::string words = last_line(store_.log_path(hash));
    if (status == kCannotBeStarted)  // the run stays open
      throw ComputationFailed(fmt::format("{}: cannot be started", worker_.program.string()));
    if (status > kKilled && status != kInterrupted)
      store_.fail(
          hash, status,
          fmt::format("its process was killed by signal {} ({}){}", status - kKilled,
                      ::strsignal(status - kKilled), words.empty() ? "" : "; it last said: " + words));
    else if (status != 0 && status != kInterrupted)
      store_.fail(hash, status, words);
  }

  Store& store_;
  Command worker_;
  std::map<std::string, Process> child_of_;
};

}  // namespace

void run_locally(Store& store, OpenRuns& open, const ExecuteOptions& options) {
  const std::size_t cores = options.cores > 0 ? static_cast<std::size_t>(options.cores) : thread_count();
  Children children(store, options.worker);
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
