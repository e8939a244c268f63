// Writes a made-up micropipette test at the paper's scale, frames and calibration, to try `pendular pipette`
// on:
//   pipette_phantom FOLDER normal|tangential BRIDGE_STIFFNESS_N_PER_M

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "pipette/phantom.h"

int main(int count, char** words) {
  using namespace pendular;
  if (count != 4) {
    fmt::print(stderr, "usage: pipette_phantom FOLDER normal|tangential BRIDGE_STIFFNESS_N_PER_M\n");
    return 2;
  }
  try {
    const fs::path folder = words[1];
    pipette::Phantom phantom;
    phantom.direction = std::strcmp(words[2], "tangential") == 0 ? pipette::Direction::tangential
                                                                 : pipette::Direction::normal;
    phantom.bridge_stiffness = std::atof(words[3]);
    phantom.width = 880;
    phantom.height = 520;
    phantom.bead_diameter = 266.0;  // 365 um at 1.37 um per pixel
    phantom.neck_diameter = 96.0;
    phantom.stage_travel = 60.0;
    phantom.loading = 60;
    phantom.unloading = 57;
    phantom.dropped = 12;
    make_folder(folder / "frames");
    pipette::write_phantom(folder / "frames", phantom);
    write_text(folder / "calibration.toml", pipette::to_toml(pipette::phantom_calibration(phantom)));
  } catch (const Error& error) {
    fmt::print(stderr, "pipette_phantom: {}\n", error.what());
    return error.exit_status();
  }
  return 0;
}
