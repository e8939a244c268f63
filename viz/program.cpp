#include "viz/program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "base/interrupt.h"

extern char** environ;

namespace pendular::viz {
namespace {

constexpr int kNotFound = 127;  // as a shell says it
constexpr auto kWait = std::chrono::milliseconds(2);

}  // namespace

std::optional<int> run_program(std::vector<std::string> words, const fs::path& folder,
                               const fs::path& errors) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int fd : {0, 1}) posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", O_RDWR, 0);
  const std::string log = errors.empty() ? "/dev/null" : errors.string();
  posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT) return kNotFound;
  if (failed != 0) return std::nullopt;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (interrupted()) ::kill(child, SIGTERM);
    std::this_thread::sleep_for(kWait);
  }
  stop_if_interrupted();
  if (!WIFEXITED(status)) return std::nullopt;
  return WEXITSTATUS(status);
}

}  // namespace pendular::viz
