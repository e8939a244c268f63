#include "base/interrupt.h"

#include <atomic>
#include <csignal>

#include "base/error.h"

namespace pendular {
namespace {

std::atomic<bool> stop_asked{false};

extern "C" void ask_to_stop(int) {
  stop_asked = true;
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file larger than the quota is then a failed write, said like a full disc
}

bool interrupted() {
  return stop_asked;
}

void stop_if_interrupted() {
  if (stop_asked) throw Interrupted();
}

}  // namespace pendular
