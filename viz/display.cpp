#include "viz/display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "base/error.h"
#include "base/interrupt.h"

namespace pendular::viz {
namespace {

bool offers_opengl(const char* name) {
  const Display::Connection display(XOpenDisplay(name));
  int opcode = 0, event = 0, error = 0;
  return display && XQueryExtension(display.get(), "GLX", &opcode, &event, &error) != 0;
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
  if (const char* named = std::getenv("DISPLAY")) name_ = named;
  if (!name_.empty() && offers_opengl(name_.c_str())) return;

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw ComputationFailed("no pipe to start Xvfb with");
  // Ctrl-C is for the program, which ends the server itself once its windows are closed.
  server_.emplace(
      Command{"Xvfb", {"-displayfd", "3", "-screen", "0", "640x480x24", "-nolisten", "tcp", "-noreset"}},
      Surroundings{.apart = true, .handed = ends[1]});
  ::close(ends[1]);
  const std::string number = read_number(ends[0]);
  ::close(ends[0]);
  if (number.empty()) {
    server_->ask_to_end();
    const int status = server_->wait();
    stop_if_interrupted();
    if (status == kCannotBeStarted)
      throw ComputationFailed(
          "pictures need an X server: Xvfb not found (Debian package xvfb), and no usable DISPLAY");
    throw ComputationFailed("pictures need an X server: Xvfb did not start, and no usable DISPLAY");
  }
  name_ = ":" + number;
}

Display::~Display() = default;

void Display::Close::operator()(_XDisplay* connection) const {
  XCloseDisplay(connection);
}

Display::Connection Display::connect() const {
  Connection connection(XOpenDisplay(name_.c_str()));
  if (!connection) throw ComputationFailed(fmt::format("the X display {} does not answer", name_));
  return connection;
}

}  // namespace pendular::viz
