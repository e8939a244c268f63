#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace pendular {

/// Errors that end the program. What a user reads is one line: where, what was found, what was expected.
/// The exit status belongs to the kind of error (2 usage, 3 input, 4 computation, 130 interrupted).
class Error : public std::runtime_error {
 public:
  Error(int exit_status, const std::string& message)
      : std::runtime_error(message), exit_status_(exit_status) {}
  int exit_status() const { return exit_status_; }

 private:
  int exit_status_;
};

/// The command line does not make sense (exit 2).
struct BadUsage : Error {
  explicit BadUsage(const std::string& message) : Error(2, message) {}
};

/// A file or value given by the user is wrong (exit 3).
struct BadInput : Error {
  explicit BadInput(const std::string& message) : Error(3, message) {}
};

/// The input was right but the work failed: diverged, out of memory, disc full (exit 4).
struct ComputationFailed : Error {
  explicit ComputationFailed(const std::string& message) : Error(4, message) {}
};

/// The user stopped the program (exit 130).
struct Interrupted : Error {
  explicit Interrupted(const std::string& message = "interrupted") : Error(130, message) {}
};

/// Throws BadInput with a message in fmt's format.
template <typename... Args>
[[noreturn]] void bad_input(fmt::format_string<Args...> format, Args&&... args) {
  throw BadInput(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace pendular
