#include "base/own_process.h"

#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

#include "base/interrupt.h"

namespace pendular {
namespace {

std::atomic<bool> owned{false};

/// Nothing but this may be done where a byte of a mapped file is not there.
extern "C" void end_with_one_line(int) {
  constexpr char line[] = "pendular: an input file was cut short or could not be read while it was in use\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line, sizeof(line) - 1);
  ::_exit(4);
}

}  // namespace

void keep_freed_memory() {
  // Pages that the kernel takes back it clears before they return: a third of the time of small volumes, a
  // sixth of a diagnosis.
  ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
  ::mallopt(M_MMAP_THRESHOLD, 128 << 20);  // which the line before would fix at 128 kB
}

void own_process() {
  owned = true;
  catch_interrupts();
  keep_freed_memory();
  struct sigaction action {};
  action.sa_handler = end_with_one_line;
  ::sigaction(SIGBUS, &action, nullptr);
}

SilentStandardError::SilentStandardError() {
  if (!owned) return;
  std::fflush(stderr);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  kept_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  if (kept_ >= 0) ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

SilentStandardError::~SilentStandardError() {
  if (kept_ < 0) return;
  std::fflush(stderr);
  ::dup2(kept_, STDERR_FILENO);
  ::close(kept_);
}

}  // namespace pendular
