// Yade as a process: its scripts are part of the program and go into the folder of the run.

#include "base/error.h"
#include "base/process.h"
#include "blind/engine_run.h"
#include "blind/yade_scripts.h"

namespace pendular::blind {
namespace {

constexpr const char* kYade = "yade";

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
  const Command command{kYade, {"-j1", "-n", "-x", (folder / "compress.py").string(), folder.string()}};
  if (const int status = pendular::run(command, {.log = log}); status != 0)
    throw ComputationFailed(
        fmt::format("engine {}: yade ended with status {}: {}", run.engine.name, status, last_line(log)));
  return read_result(result, run.packing.beads.size(), run.frame_at.size());
}

}  // namespace pendular::blind
