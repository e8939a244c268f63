#include "sweep/worker_id.h"

#include <unistd.h>

#include <array>
#include <fstream>
#include <iterator>
#include <sstream>

namespace pendular::sweep {
namespace {

constexpr double kLongestSilence = 300.0;  // s

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// Start of a process in clock ticks (proc(5), field 22 of stat); -1 where there is none or it is dead.
std::int64_t start_of(std::int64_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto name_end = text.rfind(')');  // the name may hold spaces and brackets
  if (name_end == std::string::npos) return -1;
  std::istringstream fields(text.substr(name_end + 1));
  std::string field, state;
  fields >> state;
  if (state == "Z" || state == "X") return -1;
  for (int k = 4; k <= 22; ++k) fields >> field;
  return std::stoll(field);
}

}  // namespace

WorkerId this_worker() {
  return {host_name(), ::getpid(), start_of(::getpid())};
}

bool alive(const WorkerId& worker, double seconds_since_sign) {
  if (worker.host != host_name()) return seconds_since_sign < kLongestSilence;
  return start_of(worker.pid) == worker.started;
}

}  // namespace pendular::sweep
