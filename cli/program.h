#pragma once

#include <string>
#include <vector>

namespace pendular::cli {

/// Runs one command line (without the program's name), as typed in a shell. Throws pendular::Error, or
/// CLI::Error for a line that does not parse or asks for help.
void run_command_line(const std::vector<std::string>& words);

/// The same, and prints what there is to say: a single line for an error. Returns the exit status.
int run_program(const std::vector<std::string>& words);

}  // namespace pendular::cli
