#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"

namespace pendular {

/// A program and the words after its name.
struct Command {
  fs::path program;  ///< a file, or a name that is looked for on PATH
  std::vector<std::string> words = {};

  /// The same with further words.
  Command with(const std::vector<std::string>& further) const;
};

/// The exit status of a process whose program cannot be started.
inline constexpr int kCannotBeStarted = 127;

/// Where the shell would find a program; empty: nowhere.
fs::path found_on_path(const std::string& name);

/// How a process starts. It has no input; what it says goes to `log`, or nowhere.
struct Surroundings {
  fs::path log = {};     ///< written anew
  fs::path folder = {};  ///< that it works in; empty: this one's
  bool apart = false;    ///< Ctrl-C at the terminal does not reach it
  int handed = -1;       ///< a descriptor that it gets as number 3; none below zero
};

/// A process of another program. It goes when this process does.
class Process {
 public:
  /// ComputationFailed where no process can be started or its log not be written. Where only its program
  /// cannot be, it ends with kCannotBeStarted.
  explicit Process(const Command& command, const Surroundings& surroundings = {});
  /// Ends it by SIGTERM where it still runs, and waits until it is gone.
  ~Process();
  Process(Process&& other) noexcept : child_(other.child_), status_(other.status_) { other.child_ = -1; }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  Process& operator=(Process&&) = delete;

  /// Its exit status, 128 + signal where one killed it; nothing while it runs.
  std::optional<int> ended();
  /// Waits for that.
  int wait();
  /// Asks it to end; it may first keep what it has.
  void ask_to_end() const;

 private:
  pid_t child_;
  int status_ = 0;  // once child_ is -1
};

/// Waits until a process ends and returns its exit status; Interrupted where the user stops this program.
int watch(Process& process);

/// Runs a command to its end; where the user stops this program it is ended too and Interrupted is thrown.
int run(const Command& command, const Surroundings& surroundings = {});

/// What a command says on standard output and errors, and its exit status.
struct Answer {
  int status = 0;
  std::string text;
};
Answer ask(const Command& command);

/// What work returns that is done in a copy of this process: for libraries that may end the process on bad
/// input. Status 0, or 128 + signal, or 1 where it threw or exited.
Answer run_apart(const std::function<std::string()>& work);

/// The last line that a process wrote to its log, for messages; empty where there is none.
std::string last_line(const fs::path& log);

}  // namespace pendular
