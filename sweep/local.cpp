#include <algorithm>
#include <chrono>
#include <cstring>
#include <list>
#include <map>
#include <set>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "dem_core/compress.h"
#include "sweep/executors.h"

namespace pendular::sweep {
namespace {

using Clock = std::chrono::steady_clock;

/// With fewer in the lanes of a register a run takes longer than it does alone, on a thread of its own.
constexpr std::size_t kLeastSideBySide = 6;

/// What runs have in common that can be made side by side, as far as their requests tell.
std::string kind_of(const RunRequest& request) {
  const Sample& sample = request.sample;
  return fmt::format("{} {} {} {} {} {} {} {} {}", sample.specimen.diameter, sample.specimen.height,
                     sample.compression.max_strain, static_cast<int>(sample.compression.control),
                     static_cast<int>(sample.contact.tangential_springs), sample.contact.bond_friction_limit,
                     static_cast<int>(sample.contact.glass), static_cast<int>(sample.bridges.breaking),
                     request.packing.sha256.empty() ? packing_hash(request) : "");
}

/// Runs made by child processes, which go when this process does.
class Children {
 public:
  Children(Store& store, const Command& worker) : store_(store), worker_(worker) {}
  ~Children() { stop(); }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  std::size_t count() const { return children_.size(); }

  bool makes(const std::string& hash) const {
    return std::any_of(children_.begin(), children_.end(), [&](const Child& child) {
      return std::find(child.hashes.begin(), child.hashes.end(), hash) != child.hashes.end();
    });
  }

  /// Starts a process for the first of some runs, and for those that it can make side by side with it so that
  /// all are done earlier on so many cores.
  void start(std::span<const std::string> free, std::size_t cores, std::size_t threads) {
    std::vector<std::string> hashes = {free.front()};
    for (const auto& hash : free.subspan(1))
      if (!alone_.contains(free.front()) && !alone_.contains(hash) && kind(hash) == kind(free.front()))
        hashes.push_back(hash);
    std::size_t open = free.size();  // of other kinds, too: they are for the other cores
    for (const auto& child : children_) open += child.hashes.size();
    const std::size_t share =
        std::min({dem_core::kMostSideBySide, hashes.size(), (open + cores - 1) / cores});
    hashes.resize(share >= kLeastSideBySide ? share : 1);

    std::vector<std::string> words = {fs::absolute(store_.folder()).string()};
    words.insert(words.end(), hashes.begin(), hashes.end());
    words.insert(words.end(), {"--threads", std::to_string(hashes.size() > 1 ? 1 : threads)});
    Process process(worker_.with(words), {.log = store_.log_path(hashes.front())});
    children_.push_back({std::move(hashes), std::move(process)});
  }

  /// Whether one has ended. What it has not told the store itself is told for it.
  bool one_ended() {
    for (auto child = children_.begin(); child != children_.end(); ++child) {
      const auto status = child->process.ended();
      if (!status) continue;
      const std::vector<std::string> hashes = child->hashes;
      children_.erase(child);
      if (*status == kCannotBeStarted)  // the runs stay open
        throw ComputationFailed(fmt::format("{}: cannot be started", worker_.program.string()));
      // What several have left is made by processes of their own: then a fault is known to be a run's.
      if (hashes.size() > 1)
        alone_.insert(hashes.begin(), hashes.end());
      else
        book_end(hashes.front(), *status);
      return true;
    }
    return false;
  }

  /// Lets all keep their checkpoints and end.
  void stop() {
    for (const auto& child : children_) child.process.ask_to_end();
    children_.clear();
  }

 private:
  struct Child {
    std::vector<std::string> hashes;
    Process process;
  };

  const std::string& kind(const std::string& hash) {
    auto found = kinds_.find(hash);
    if (found == kinds_.end()) found = kinds_.emplace(hash, kind_of(store_.request(hash))).first;
    return found->second;
  }

  void book_end(const std::string& hash, int status) {
    constexpr int kKilled = 128, kInterrupted = 130;
    const RunRecord record = store_.record(hash);
    if (!record.free()) return;
    const std::string words = last_line(store_.log_path(hash));
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
  std::list<Child> children_;
  std::map<std::string, std::string> kinds_;
  std::set<std::string> alone_;
};

/// Runs that no process makes.
std::vector<std::string> free_runs(const OpenRuns& open, const Children& children) {
  std::vector<std::string> found;
  for (const auto& record : open.records())
    if (record.free() && !children.makes(record.hash)) found.push_back(record.hash);
  return found;
}

}  // namespace

void run_locally(Store& store, OpenRuns& open, const ExecuteOptions& options) {
  const std::size_t cores = options.cores > 0 ? static_cast<std::size_t>(options.cores) : thread_count();
  Children children(store, options.worker);
  auto asked = Clock::now();
  while (!open.records().empty()) {
    const std::size_t at_once = std::min(cores, open.records().size());
    while (children.count() < at_once) {
      const std::vector<std::string> free = free_runs(open, children);
      if (free.empty()) break;
      children.start(free, cores, cores / at_once);
    }
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
