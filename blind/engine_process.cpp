// Yade as a process: its scripts are part of the program and go into the folder of the run.

#include <unistd.h>

#include <cstdlib>
#include <sstream>

#include "base/error.h"
#include "blind/engine_run.h"
#include "blind/processes.h"
#include "blind/yade_scripts.h"

namespace pendular::blind {
namespace {

constexpr const char* kYade = "yade";

/// Where the shell would find a program; empty: nowhere.
fs::path found_on_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / name; ::access(file.c_str(), X_OK) == 0) return file;
  return {};
}

}  // namespace

void require_installed(const Engine& engine) {
  if (engine.outside() && found_on_path(kYade).empty())
    throw ComputationFailed(
        fmt::format("engine {}: yade is not installed (Debian: apt-get install yade)", engine.name));
}

EngineResult run_engine(const EngineRun& run, const fs::path& folder) {
  require_installed(run.engine);
  make_folder(folder);
  for (const auto& [name, text] : yade_scripts()) write_text(folder / name, text);
  write_text(folder / "run.json", run_text(run));
  const fs::path result = folder / "result.json", log = folder / "log.txt";
  fs::remove(result);
  // One thread, no window, and an end when the script ends.
  const Job job{
      {"-j1", "-n", "-x", (folder / "compress.py").string(), folder.string()}, log, found_on_path(kYade)};
  run_jobs({job}, 1, [&](std::size_t, int status) {
    if (status != 0)
      throw ComputationFailed(
          fmt::format("engine {}: yade ended with status {}: {}", run.engine.name, status, last_line(log)));
  });
  return read_result(result, run.packing.beads.size(), run.frame_at.size());
}

}  // namespace pendular::blind
