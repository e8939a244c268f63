#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/own_process.h"
#include "cli/command.h"
#include "cli/picture_commands.h"
#include "cli/program.h"

namespace pendular::cli {

void add_commands(CLI::App& app) {
  for (const char* name : {"demo", "phantom", "segment", "track"}) add_picture_command(app, name);
  add_pack(app);
  add_picture_command(app, "bridge");
  add_compress(app);
  add_modulus(app);
  add_picture_command(app, "render");
  add_convert(app);
  add_picture_command(app, "pipette");
  add_sweep(app);
  add_picture_command(app, "reproduce");
  add_picture_command(app, "diagnose");
  add_blind(app);
  add_doctor(app);
  add_sweep_run(app);
  add_blind_case(app);
  add_formats(app);
}

namespace {

/// Returns only where it cannot be started: the exit status.
int become_pictures_program(char** words) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "pendular-pictures";
  ::execv(program.c_str(), words);
  fmt::print(stderr, "pendular: {}: cannot be started: {}\n", program.string(), std::strerror(errno));
  return 4;
}

}  // namespace
}  // namespace pendular::cli

int main(int argc, char** argv) {
  using namespace pendular;
  cli::open_standard_streams();
  if (argc > 1 && cli::is_picture_command(argv[1])) return cli::become_pictures_program(argv);
  own_process();
  return cli::run_program({argv + 1, argv + argc});
}
