#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"

namespace pendular::python {

/// The library's state while one call from Python works: calls wait for each other, their messages go to a
/// listener, and Ctrl-C asks the work to stop. Calls made from within a call (by its callbacks, on its
/// thread) are let through.
///
/// The handler of SIGINT that was there is called too, so that Python knows of the signal; where there is
/// none, or the call does not come from the main thread, nothing is caught.
class Session {
 public:
  Session(Listener listener, int threads);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::lock_guard<std::recursive_mutex> alone_;
  std::optional<Listener> outer_;
  bool catches_ = false;
};

}  // namespace pendular::python
