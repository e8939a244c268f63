#include "session/session.h"

#include <signal.h>
#include <unistd.h>

#include "base/files.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace pendular::python {
namespace {

std::recursive_mutex calls;
int depth = 0;
struct sigaction earlier;

extern "C" void on_interrupt(int signal) {
  ask_to_stop();
  earlier.sa_handler(signal);
}

bool on_main_thread() {
  return ::gettid() == ::getpid();
}

/// Whether a handler is in force now that has to be undone.
bool catch_interrupt() {
  if (!on_main_thread() || ::sigaction(SIGINT, nullptr, &earlier) != 0) return false;
  const bool handled =
      (earlier.sa_flags & SA_SIGINFO) == 0 && earlier.sa_handler != SIG_DFL && earlier.sa_handler != SIG_IGN;
  if (!handled) return false;
  struct sigaction ours = earlier;
  ours.sa_handler = on_interrupt;
  return ::sigaction(SIGINT, &ours, nullptr) == 0;
}

}  // namespace

Session::Session(Listener listener, int threads) : alone_(calls) {
  outer_ = set_listener(std::move(listener));
  if (depth++ > 0) return;
  go_on();
  set_threads(threads);
  catches_ = catch_interrupt();
}

Session::~Session() {
  set_listener(std::move(outer_));
  if (--depth > 0) return;
  protect_inputs({});
  if (catches_) ::sigaction(SIGINT, &earlier, nullptr);
  go_on();
}

}  // namespace pendular::python
