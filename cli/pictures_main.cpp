#include "base/own_process.h"
#include "cli/command.h"
#include "cli/program.h"

namespace pendular::cli {

void add_commands(CLI::App& app) {
  add_demo(app);
  add_phantom(app);
  add_segment(app);
  add_track(app);
  add_pack(app);
  add_bridge(app);
  add_compress(app);
  add_modulus(app);
  add_render(app);
  add_convert(app);
  add_pipette(app);
  add_sweep(app);
  add_reproduce(app);
  add_diagnose(app);
  add_blind(app);
  add_doctor(app);
  add_sweep_run(app);
  add_blind_case(app);
  add_formats(app);
  add_manual(app);
}

}  // namespace pendular::cli

int main(int argc, char** argv) {
  pendular::cli::open_standard_streams();
  pendular::own_process();
  return pendular::cli::run_program({argv + 1, argv + argc});
}
