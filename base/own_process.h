#pragma once

namespace pendular {

/// For main(), and for children that work by themselves: from here on the process is the program's own.
/// SIGINT and SIGTERM ask to stop (base/interrupt.h), a mapped file that is cut short while in use ends the
/// process with one line and status 4, SilentStandardError acts, and freed memory is kept. Without this call
/// no library of this project changes signals, environment, standard error or the allocator: they are the
/// caller's (a Python session's).
void own_process();

/// Up to 256 MB of freed memory stay with the process, for arrays that are asked for again and again.
void keep_freed_memory();

/// In a process of the program's own, standard error goes nowhere while this object lives: the user is to
/// read one line, and ITK, OpenCV, Mesa and Xlib write theirs there. Elsewhere nothing.
class SilentStandardError {
 public:
  SilentStandardError();
  ~SilentStandardError();
  SilentStandardError(const SilentStandardError&) = delete;
  SilentStandardError& operator=(const SilentStandardError&) = delete;

 private:
  int kept_ = -1;
};

}  // namespace pendular
