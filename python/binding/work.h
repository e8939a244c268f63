#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "session/session.h"

namespace pendular::python {

namespace py = pybind11;

/// What every call that works takes.
struct Terms {
  py::object progress = py::none();  ///< callable(what, done, note), or None
  int threads = 0;                   ///< 0: one per core
};

/// What a call told on its way, for Python once it is back.
class Told {
 public:
  explicit Told(py::object progress);
  Listener listener();

  /// Issues the warnings.
  void warn() const;

  /// Throws what the stop was about: the callback's own exception, or KeyboardInterrupt.
  [[noreturn]] void stop(const Interrupted& stopped);

 private:
  py::object progress_;
  std::vector<std::string> warnings_;
  std::optional<py::error_already_set> failed_;
};

/// Runs `call` without the interpreter's lock and returns its result. Its warnings become Python warnings.
template <typename Call>
auto work(const Terms& terms, Call&& call) {
  Told told(terms.progress);
  std::optional<decltype(call())> result;
  try {
    const py::gil_scoped_release released;
    const Session session(told.listener(), terms.threads);
    result.emplace(call());
  } catch (const Interrupted& stopped) {
    told.stop(stopped);
  } catch (const Error&) {
    told.warn();
    throw;
  }
  told.warn();
  return std::move(*result);
}

/// Turns the library's errors into those of pendular.errors; once in each module.
void translate_errors();

}  // namespace pendular::python
