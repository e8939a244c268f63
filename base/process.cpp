#include "base/process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/path_kind.h"

namespace pendular {
namespace {

/// A descriptor that is closed where it is left.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

[[noreturn]] void no_process(int why) {
  throw ComputationFailed(fmt::format("no process can be started: {}", std::strerror(why)));
}

/// What a new process needs to become its program; made before fork.
struct Start {
  std::string program, folder;
  std::vector<std::string> words;
  std::vector<char*> pointers;
  int input, output, handed;
  bool apart;
  pid_t parent;

  Start(const Command& command, const Surroundings& surroundings, int in, int out)
      : folder(surroundings.folder.string()),
        words(command.words),
        input(in),
        output(out),
        handed(surroundings.handed),
        apart(surroundings.apart),
        parent(::getpid()) {
    const bool name_only = !command.program.has_parent_path();
    program = (name_only ? found_on_path(command.program.string()) : command.program).string();
    words.insert(words.begin(), command.program.filename().string());
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
  }

  /// In the new process, where only calls safe after fork are allowed.
  [[noreturn]] void become() const {
    if (apart) ::setsid();
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(130);  // it went before it could be watched
    if (!folder.empty() && ::chdir(folder.c_str()) != 0) ::_exit(kCannotBeStarted);
    ::dup2(input, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    if (handed == 3) ::fcntl(3, F_SETFD, 0);
    if (handed >= 0 && handed != 3) ::dup2(handed, 3);
    ::execv(program.c_str(), pointers.data());
    ::_exit(kCannotBeStarted);
  }
};

pid_t started(const Command& command, const Surroundings& surroundings, int output) {
  const Descriptor input(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const Start start(command, surroundings, input.number(), output);
  const pid_t child = ::fork();
  if (child == 0) start.become();
  if (child < 0) no_process(errno);
  return child;
}

pid_t started(const Command& command, const Surroundings& surroundings) {
  const std::string log = surroundings.log.empty() ? "/dev/null" : surroundings.log.string();
  const Descriptor output(::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (output.number() < 0)
    throw ComputationFailed(fmt::format("{}: cannot be written: {}", log, std::strerror(errno)));
  return started(command, surroundings, output.number());
}

int status_of(int how) {
  return WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
}

int waited_for(pid_t child) {
  int how = 0;
  while (::waitpid(child, &how, 0) < 0 && errno == EINTR) {
  }
  return status_of(how);
}

std::string all_of(int descriptor) {
  std::string text;
  char part[4096];
  for (ssize_t got = 0; (got = ::read(descriptor, part, sizeof part)) > 0 || (got < 0 && errno == EINTR);)
    if (got > 0) text.append(part, static_cast<std::size_t>(got));
  return text;
}

}  // namespace

Command Command::with(const std::vector<std::string>& further) const {
  Command longer = *this;
  longer.words.insert(longer.words.end(), further.begin(), further.end());
  return longer;
}

fs::path found_on_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (fs::path file = fs::path(folder) / name; ::access(file.c_str(), X_OK) == 0) return file;
  return {};
}

Process::Process(const Command& command, const Surroundings& surroundings)
    : child_(started(command, surroundings)) {}

Process::~Process() {
  if (child_ < 0) return;
  ask_to_end();
  waited_for(child_);
}

std::optional<int> Process::ended() {
  int how = 0;
  if (child_ >= 0 && ::waitpid(child_, &how, WNOHANG) == child_) child_ = -1, status_ = status_of(how);
  return child_ < 0 ? std::optional(status_) : std::nullopt;
}

int Process::wait() {
  if (child_ >= 0) status_ = waited_for(child_), child_ = -1;
  return status_;
}

void Process::ask_to_end() const {
  if (child_ >= 0) ::kill(child_, SIGTERM);
}

int watch(Process& process) {
  while (!process.ended()) {
    stop_if_interrupted();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  stop_if_interrupted();
  return process.wait();
}

int run(const Command& command, const Surroundings& surroundings) {
  Process process(command, surroundings);
  return watch(process);
}

Answer ask(const Command& command) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) no_process(errno);
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  const pid_t child = started(command, {}, in.number());
  in.close();
  Answer answer;
  answer.text = all_of(out.number());
  answer.status = waited_for(child);
  return answer;
}

Answer run_apart(const std::function<std::string()>& work) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) no_process(errno);
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  const pid_t child = ::fork();
  if (child < 0) no_process(errno);
  if (child == 0) {
    try {
      const std::string told = work();
      [[maybe_unused]] const auto written = ::write(in.number(), told.data(), told.size());
      ::_exit(0);
    } catch (...) {
    }
    ::_exit(1);
  }
  in.close();
  Answer answer;
  answer.text = all_of(out.number());
  answer.status = waited_for(child);
  return answer;
}

std::string last_line(const fs::path& log) {
  if (!is_there(log)) return "";
  std::string text = read_text(log);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace pendular
