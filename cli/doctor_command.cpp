#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>

#include "base/error.h"
#include "base/process.h"
#include "cli/command.h"
#include "cli/own_program.h"

namespace pendular::cli {
namespace {

/// Something that is not in the program itself. `found`: where it is; empty: it is absent.
struct Part {
  std::string name, serves, found, remedy;
};

std::string companion() {
  fs::path program = own_program();
  if (fs::is_symlink(program)) program = fs::read_symlink(program);
  const fs::path file = program.parent_path() / "pendular-pictures";
  return ::access(file.c_str(), X_OK) == 0 ? file.string() : "";
}

std::string display() {
  if (std::string server = found_on_path("Xvfb"); !server.empty()) return server;
  const char* named = std::getenv("DISPLAY");
  return named && *named ? fmt::format("DISPLAY={}", named) : "";
}

std::string python_module() {
  return ask({"python3", {"-c", "import pendular"}}).status == 0 ? "python3: import pendular" : "";
}

std::vector<Part> parts() {
  return {
      {"pendular-pictures", "commands that read or draw pictures", companion(), "install it beside pendular"},
      {"X server", "pictures, films, reports", display(), "apt-get install xvfb"},
      {"gnuplot", "charts: bridge, pipette, render, diagnose, reproduce", found_on_path("gnuplot"),
       "apt-get install gnuplot-nox fonts-liberation"},
      {"ffmpeg", "films as .mp4; else numbered pictures", found_on_path("ffmpeg"), "apt-get install ffmpeg"},
      {"Python module", "import pendular", python_module(), "cmake --preset release -DPENDULAR_PYTHON=ON"},
      {"Slurm", "sweep, diagnose --executor slurm", found_on_path("sbatch"), "apt-get install slurm-wlm"},
      {"Yade", "blind cases by another engine", found_on_path("yade"), "apt-get install yade"},
      {"Chromium", "opening report.html; tests of it", found_on_path("chromium"),
       "apt-get install chromium"}};
}

void run() {
  fmt::print("pendular {}\n", program_version());
  bool pictures = true;
  for (const auto& [name, serves, found, remedy] : parts()) {
    fmt::print("{:<7}  {:<17}  {:<52}  {}\n", found.empty() ? "absent" : "present", name, serves,
               found.empty() ? remedy : found);
    if (name == "pendular-pictures" || name == "X server") pictures = pictures && !found.empty();
  }
  if (!pictures)
    throw ComputationFailed("doctor: commands that read or draw pictures do not work, see the lines above");
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto* command = app.add_subcommand(
      "doctor",
      "Which optional parts are there, what each serves, and how to get those that are absent.\n"
      "Status 4 where commands that read or draw pictures cannot work.");
  command->callback([] { run(); });
}

}  // namespace pendular::cli
