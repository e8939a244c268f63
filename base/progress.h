#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace pendular {

/// Silences everything but errors (--quiet).
void set_quiet(bool quiet);

/// One line of information for the user, on standard error.
void say(const std::string& line);

/// One line of warning, shown also under --quiet.
void warn(const std::string& line);

/// Who is told, in the place of standard error; called on the threads that work, one call at a time. What is
/// null is told to nobody.
struct Listener {
  std::function<void(const std::string&line)> said, warned;
  /// What is done, its share from 0 to 1, and the note of Progress::update(); ten times a second at most.
  std::function<void(const std::string& what, double share, const std::string& note)> progress;
};

/// From here on; nothing: standard error again. Returns who was told before.
std::optional<Listener> set_listener(std::optional<Listener> listener);

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
  Clock::time_point start_, next_, next_told_;
  double interval_ = 2.0;
  bool shown_ = false, listened_ = false;
};

}  // namespace pendular
