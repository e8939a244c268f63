#include "cli/program.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>

#include "base/error.h"
#include "base/text_line.h"
#include "cli/command.h"

namespace pendular::cli {
namespace {

constexpr const char* kChain =
    R"(pendular segment scan.mha --voxel-um 5 -o beads.csv         a tomogram to beads (and bridges)
pendular pack beads.csv --sample s.toml -o packing.vtp      beads to a packing with its statistics
pendular compress packing.vtp --sample s.toml -o run/       uniaxial compression, discrete elements
pendular render run/ -o pictures/                           shear band, stress-strain curve, film
pendular diagnose experiment.toml -o report/                why simulation and experiment differ

All of it on a phantom: pendular demo. Commands: pendular --help. Optional parts: pendular doctor.
)";

CLI::App new_app() {
  return CLI::App("From a tomogram of bonded beads to its stiffness, its failure, and the reason why.",
                  "pendular");
}

void prepare(CLI::App& app) {
  app.set_version_flag("--version", program_version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(36);
  add_commands(app);
}

/// An empty name or value would pass for one that was not given, or take the next word in its place.
void require_no_empty_word(const std::vector<std::string>& words) {
  for (std::size_t k = 0; k < words.size(); ++k) {
    const bool empty = words[k].empty(),
               nothing_given = words[k].starts_with("--") && words[k].find('=') == words[k].size() - 1;
    if (empty || nothing_given)
      throw BadUsage(fmt::format("{}: found nothing, expected a name or a value",
                                 empty && k > 0 ? words[k - 1] : words[k]));
  }
}

void parse(CLI::App& app, const std::vector<std::string>& words) {
  set_command_line(words);
  require_no_empty_word(words);
  if (!words.empty() && words[0][0] != '-' &&
      app.get_subcommands([&](CLI::App* command) { return command->get_name() == words[0]; }).empty())
    throw BadUsage(fmt::format("unknown command \"{}\" (see pendular --help)", words[0]));
  app.parse(
      std::vector<std::string>(words.rbegin(), words.rend()));  // the library takes them last word first
}

int fail(int status, const std::string& line) {
  std::fputs((text_line("pendular: " + line) + '\n').c_str(), stderr);
  return status;
}

/// What was printed may still wait for a disc that is full.
int printed() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::cout && std::ferror(stdout) == 0) return 0;
  return fail(4, fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
}

}  // namespace

void open_standard_streams() {
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) == -1) ::open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
}

void run_command_line(const std::vector<std::string>& words) {
  CLI::App app = new_app();
  prepare(app);
  parse(app, words);
}

int run_program(const std::vector<std::string>& words) {
  if (words.empty()) {
    fmt::print("{}", kChain);
    return printed();
  }
  CLI::App app = new_app();
  prepare(app);
  try {
    parse(app, words);
    return printed();
  } catch (const CLI::Success& wanted) {  // help or version
    app.exit(wanted);
    return printed();
  } catch (const CLI::Error& error) {
    return fail(2, std::string(error.what()) + " (see pendular --help)");
  } catch (const Error& error) {
    return fail(error.exit_status(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(4, "out of memory");
  } catch (const fs::filesystem_error& error) {
    return fail(4, fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::exception& error) {
    return fail(4, error.what());
  }
}

}  // namespace pendular::cli
