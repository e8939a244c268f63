#include "base/interrupt.h"

#include <atomic>
#include <csignal>

#include "base/error.h"

namespace pendular {
namespace {

std::atomic<bool> stop_asked{false};

extern "C" void on_signal(int) {
  ask_to_stop();
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file larger than the quota is then a failed write, said like a full disc
}

void ask_to_stop() {
  stop_asked = true;
}

void go_on() {
  stop_asked = false;
}

bool interrupted() {
  return stop_asked;
}

void stop_if_interrupted() {
  if (stop_asked) throw Interrupted();
}

}  // namespace pendular
