#include "base/interrupt.h"
#include "cli/program.h"

int main(int argc, char** argv) {
  pendular::catch_interrupts();
  return pendular::cli::run_program({argv + 1, argv + argc});
}
