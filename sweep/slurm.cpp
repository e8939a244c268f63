#include <unistd.h>

#include <chrono>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "sweep/executors.h"

namespace pendular::sweep {
namespace {

constexpr std::size_t kLargestArray = 1000;  // Slurm's own limit, unless it is configured otherwise
constexpr int kGoneFor = 3;                  // times of asking after which a job counts as lost

/// A task of a job array, as squeue names it: "JOB_INDEX".
using Task = std::string;

/// Options of sbatch are typed as in a shell.
Answer ask_shell(const std::string& command) {
  return ask({"sh", {"-c", command}});
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// As one word of a shell's command.
std::string quoted(const fs::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Job arrays that make the runs of a store.
class Arrays {
 public:
  Arrays(Store& store, const ExecuteOptions& options) : store_(store), options_(options) {}

  void submit(const std::vector<std::string>& hashes) {
    const fs::path folder = fs::absolute(store_.folder() / "slurm");
    make_folder(folder);
    const std::string name = fmt::format("{}-{}", ::getpid(), jobs_.size());
    const fs::path list = folder / (name + ".txt"), script = folder / (name + ".sh");
    write_text(list, fmt::format("{}\n", fmt::join(hashes, "\n")));
    write_text(script, fmt::format("#!/bin/sh\n"
                                   "hash=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\n"
                                   "exec {} {} \"$hash\" --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" "
                                   ">{}/\"$hash\".txt 2>&1\n",
                                   quoted(list), worker_in_words(), quoted(fs::absolute(store_.folder())),
                                   quoted(fs::absolute(store_.folder() / "logs"))));
    const auto answer =
        ask_shell(fmt::format("sbatch --parsable --array=0-{} --job-name=pendular --output=/dev/null {} {}",
                              hashes.size() - 1, options_.slurm->sbatch, quoted(script)));
    const std::string job = answer.text.substr(0, answer.text.find_first_not_of("0123456789"));
    if (answer.status != 0 || job.empty())
      throw ComputationFailed(fmt::format("sbatch took no job: {}", first_line(answer.text)));
    jobs_.push_back(job);
    for (std::size_t k = 0; k < hashes.size(); ++k) task_of_[hashes[k]] = fmt::format("{}_{}", job, k);
  }

  /// Records as failed what has left the queue without a result.
  void find_lost(const std::vector<RunRecord>& open) {
    const auto queue = queued();
    if (!queue) return;
    for (const auto& record : open) {
      const auto task = task_of_.find(record.hash);
      if (task == task_of_.end()) continue;
      int& gone = gone_for_[record.hash];
      gone = queue->count(task->second) ? 0 : gone + 1;
      if (gone >= kGoneFor) book_loss(record.hash, task->second);
    }
  }

  /// Lets all keep their checkpoints and end.
  void cancel() const {
    if (!jobs_.empty()) ask_shell(fmt::format("scancel {}", fmt::join(jobs_, " ")));
  }

 private:
  /// For a shell, wherever it starts.
  std::string worker_in_words() const {
    const fs::path& program = options_.worker.program;
    std::string words = quoted(program.has_parent_path() ? fs::canonical(program) : program);
    for (const auto& word : options_.worker.words) words += " " + quoted(fs::path(word));
    return words;
  }

  /// The tasks that wait or run; nothing where the scheduler gives no answer: it may be back later, and what
  /// it runs goes on.
  std::optional<std::set<Task>> queued() {
    const auto answer = ask_shell("squeue --noheader --array --me --format='%F_%K'");
    if (answer.status != 0) {
      if (!told_) warn("squeue gives no answer, asking again: " + first_line(answer.text));
      told_ = true;
      return std::nullopt;
    }
    std::set<Task> tasks;
    std::istringstream words(answer.text);
    for (std::string word; words >> word;) tasks.insert(word);
    return tasks;
  }

  void book_loss(const std::string& hash, const Task& task) {
    const RunStatus status = store_.record(hash).status;
    if (status == RunStatus::done || status == RunStatus::failed) return;  // it ended just now
    const std::string words = last_line(store_.log_path(hash));
    store_.fail(hash, 4,
                fmt::format("lost by the scheduler: job {} has left the queue without a result{}", task,
                            words.empty() ? "" : "; it last said: " + words));
  }

  Store& store_;
  const ExecuteOptions& options_;
  std::vector<std::string> jobs_;
  std::map<std::string, Task> task_of_;
  std::map<std::string, int> gone_for_;
  bool told_ = false;
};

}  // namespace

void run_on_slurm(Store& store, OpenRuns& open, const ExecuteOptions& options) {
  Arrays arrays(store, options);
  std::vector<std::string> batch;
  for (const auto& record : open.records()) {
    if (!record.free()) continue;
    batch.push_back(record.hash);
    if (batch.size() == kLargestArray) {
      arrays.submit(batch);
      batch.clear();
    }
  }
  if (!batch.empty()) arrays.submit(batch);
  for (int beat = 1; !open.records().empty(); ++beat) {
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    if (interrupted()) {
      arrays.cancel();
      throw Interrupted("interrupted, its jobs are cancelled; the same command goes on where they stopped");
    }
    if (beat % 4 != 0) continue;
    open.ask();
    if (beat % 8 == 0) arrays.find_lost(open.records());
  }
}

}  // namespace pendular::sweep
