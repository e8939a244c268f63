#include "viz/display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"

namespace pendular::viz {
namespace {

constexpr int kExecFailed = 127;

bool offers_opengl(const char* name) {
  ::Display* display = XOpenDisplay(name);
  if (display == nullptr) return false;
  int opcode = 0, event = 0, error = 0;
  const bool glx = XQueryExtension(display, "GLX", &opcode, &event, &error) != 0;
  XCloseDisplay(display);
  return glx;
}

/// What the child does between fork and exec: only calls that are safe there.
[[noreturn]] void become_xvfb(int number_out, pid_t parent) {
  ::setsid();  // Ctrl-C is for the program, which ends the server itself once its windows are closed
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(kExecFailed);
  const int null = ::open("/dev/null", O_RDWR);
  for (int fd : {0, 1, 2}) ::dup2(null, fd);
  ::dup2(number_out, 3);
  if (number_out == 3) ::fcntl(3, F_SETFD, 0);
  ::execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "640x480x24", "-nolisten", "tcp", "-noreset",
           static_cast<char*>(nullptr));
  ::_exit(kExecFailed);
}

/// Ends a child process and waits until it is gone.
int end(pid_t child) {
  ::kill(child, SIGTERM);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// The display number that Xvfb writes once it accepts connections; empty where it ended or stays silent.
std::string read_number(int fd) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  std::string text;
  while (std::chrono::steady_clock::now() < deadline && !interrupted()) {
    pollfd wait = {fd, POLLIN, 0};
    if (::poll(&wait, 1, 200) <= 0) continue;
    char c = 0;
    if (::read(fd, &c, 1) != 1) return "";
    if (c == '\n') return text;
    text += c;
  }
  return "";
}

}  // namespace

Display::Display() {
  const char* former = std::getenv("DISPLAY");
  had_former_ = former != nullptr;
  if (had_former_) former_ = former;
  if (!former_.empty() && offers_opengl(former)) return;

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw ComputationFailed("no pipe to start Xvfb with");
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become_xvfb(ends[1], parent);
  ::close(ends[1]);
  const std::string number = child > 0 ? read_number(ends[0]) : "";
  ::close(ends[0]);
  if (number.empty()) {
    const int status = child > 0 ? end(child) : 0;
    stop_if_interrupted();
    if (WIFEXITED(status) && WEXITSTATUS(status) == kExecFailed)
      throw ComputationFailed(
          "pictures need an X server: Xvfb not found (Debian package xvfb), and no usable DISPLAY");
    throw ComputationFailed("pictures need an X server: Xvfb did not start, and no usable DISPLAY");
  }
  server_ = child;
  ::setenv("DISPLAY", (":" + number).c_str(), 1);
}

Display::~Display() {
  if (!is_private()) return;
  end(server_);
  if (had_former_)
    ::setenv("DISPLAY", former_.c_str(), 1);
  else
    ::unsetenv("DISPLAY");
}

}  // namespace pendular::viz
