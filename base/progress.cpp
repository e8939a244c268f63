#include "base/progress.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <type_traits>
#include <utility>

#include "base/text_line.h"

namespace pendular {
namespace {

spdlog::logger& logger() {
  static const auto instance = [] {
    auto made = spdlog::stderr_logger_mt("pendular");
    made->set_pattern("%v");
    return made;
  }();
  return *instance;
}

// A listener may say something itself, or set another.
std::recursive_mutex listening;

std::optional<Listener>& listener() {
  static std::optional<Listener> one;
  return one;
}

/// Whether there is a listener, who has been told.
template <typename... Values>
bool told(std::function<void(Values...)> Listener::*what, const std::type_identity_t<Values>&... values) {
  const std::lock_guard lock(listening);
  const std::optional<Listener>& one = listener();
  if (!one) return false;
  if (const auto tell = (*one).*what) tell(values...);
  return true;
}

bool on_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

std::string duration(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 3600.0)
    return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60.0), std::fmod(seconds, 60.0));
  return fmt::format("{:.0f} h {:02.0f} min", std::floor(seconds / 3600.0),
                     std::fmod(seconds, 3600.0) / 60.0);
}

}  // namespace

void set_quiet(bool quiet) {
  logger().set_level(quiet ? spdlog::level::warn : spdlog::level::info);
}

std::optional<Listener> set_listener(std::optional<Listener> next) {
  const std::lock_guard lock(listening);
  return std::exchange(listener(), std::move(next));
}

void say(const std::string& line) {
  if (told(&Listener::said, line)) return;
  logger().info(line);
}

void warn(const std::string& line) {
  if (told(&Listener::warned, line)) return;
  logger().warn(text_line("warning: " + line));
}

Progress::Progress(std::string what, double total)
    : what_(std::move(what)), total_(total), start_(Clock::now()), next_(start_ + std::chrono::seconds(2)) {}

Progress::~Progress() {
  if (shown_ && on_terminal()) std::fputs("\r\033[K", stderr);
}

void Progress::update(double done, const std::string& note) {
  if (first_ < 0.0) first_ = done;
  const auto now = Clock::now();
  const double share = std::clamp(done / total_, 0.0, 1.0);  // a last step may go a little beyond
  if (now >= next_told_) {
    listened_ = told(&Listener::progress, what_, share, note);
    next_told_ = now + std::chrono::milliseconds(100);
  }
  if (listened_) return;
  if (now < next_ || !logger().should_log(spdlog::level::info)) return;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double rate = (done - first_) / elapsed;
  // Nothing is known of the time left before the first step is done.
  const std::string left = rate > 0.0 ? fmt::format(", {} left", duration((total_ - done) / rate)) : "";
  std::string line = fmt::format("{}: {:.0f} %, {} gone{}{}{}", what_, 100.0 * share, duration(elapsed), left,
                                 note.empty() ? "" : ", ", note);
  if (on_terminal()) {
    std::fputs(("\r\033[K" + line).c_str(), stderr);
    std::fflush(stderr);
    next_ = now + std::chrono::milliseconds(500);
  } else {
    logger().info(line);
    interval_ = std::min(interval_ * 1.5, 60.0);
    next_ = now + std::chrono::milliseconds(static_cast<long>(1000.0 * interval_));
  }
  shown_ = true;
}

}  // namespace pendular
