#pragma once

#include <string>
#include <vector>

namespace pendular::cli {

/// A standard stream that is closed would be taken by the next file that is opened: it becomes one that fails
/// to be read or written. To be called first.
void open_standard_streams();

/// Runs one command line (without the program's name), as typed in a shell. Throws pendular::Error, or
/// CLI::Error for a line that does not parse or asks for help.
void run_command_line(const std::vector<std::string>& words);

/// The same, and prints what there is to say: a single line for an error. Returns the exit status.
int run_program(const std::vector<std::string>& words);

}  // namespace pendular::cli
