#include "cli/program.h"

#include <algorithm>
#include <new>

#include "base/error.h"
#include "cli/command.h"

namespace pendular::cli {
namespace {

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

void parse(CLI::App& app, const std::vector<std::string>& words) {
  set_command_line(words);
  if (!words.empty() && words[0][0] != '-' &&
      app.get_subcommands([&](CLI::App* command) { return command->get_name() == words[0]; }).empty())
    throw BadUsage(fmt::format("unknown command \"{}\" (see pendular --help)", words[0]));
  app.parse(
      std::vector<std::string>(words.rbegin(), words.rend()));  // the library takes them last word first
}

int fail(int status, std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  fmt::print(stderr, "pendular: {}\n", line);
  return status;
}

}  // namespace

void run_command_line(const std::vector<std::string>& words) {
  CLI::App app = new_app();
  prepare(app);
  parse(app, words);
}

int run_program(const std::vector<std::string>& words) {
  CLI::App app = new_app();
  prepare(app);
  try {
    parse(app, words);
    return 0;
  } catch (const CLI::Success& wanted) {  // help or version
    return app.exit(wanted);
  } catch (const CLI::Error& error) {
    return fail(2, std::string(error.what()) + " (see pendular --help)");
  } catch (const Error& error) {
    return fail(error.exit_status(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(4, "out of memory");
  } catch (const std::exception& error) {
    return fail(4, error.what());
  }
}

}  // namespace pendular::cli
