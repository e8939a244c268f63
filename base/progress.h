#pragma once

#include <chrono>
#include <string>

namespace pendular {

/// Silences everything but errors (--quiet).
void set_quiet(bool quiet);

/// One line of information for the user, on standard error.
void say(const std::string& line);

/// One line of warning, shown also under --quiet.
void warn(const std::string& line);

/// Progress of work that may take longer than two seconds: a line that renews itself on a terminal,
/// plain lines at growing intervals where standard error is redirected. Silent before two seconds have
/// passed.
class Progress {
 public:
  /// `total` in the unit that update() is given.
  Progress(std::string what, double total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `note` is shown after rate and time left, e.g. "strain 1.20 %, 0.61 MPa, 12 broken".
  void update(double done, const std::string& note = "");

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  double total_;
  double first_ = -1.0;
  Clock::time_point start_, next_;
  double interval_ = 2.0;
  bool shown_ = false;
};

}  // namespace pendular
