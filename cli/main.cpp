#include <fcntl.h>

#include "base/interrupt.h"
#include "cli/program.h"

namespace {

/// A standard stream that is closed would be taken by the next file that is opened. It becomes one that fails
/// to be read or written.
void open_standard_streams() {
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) == -1) ::open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  pendular::catch_interrupts();
  return pendular::cli::run_program({argv + 1, argv + argc});
}
