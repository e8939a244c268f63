#include <new>

#include "base/error.h"
#include "base/interrupt.h"
#include "cli/command.h"

namespace {

int fail(int status, const std::string& message) {
  std::string line = message;
  for (char& c : line)
    if (c == '\n' || c == '\r') c = ' ';
  fmt::print(stderr, "pendular: {}\n", line);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace pendular;
  catch_interrupts();
  CLI::App app("From a tomogram of bonded beads to its stiffness, its failure, and the reason why.", "pendular");
  app.set_version_flag("--version", program_version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(36);
  cli::add_demo(app);
  cli::add_phantom(app);
  cli::add_segment(app);
  cli::add_pack(app);
  cli::add_compress(app);
  cli::add_render(app);
  cli::add_convert(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& version) {
    return app.exit(version);
  } catch (const CLI::Error& error) {
    return fail(2, std::string(error.what()) + " (pendular --help)");
  } catch (const Error& error) {
    return fail(error.exit_status(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(4, "out of memory");
  } catch (const std::exception& error) {
    return fail(4, error.what());
  }
}
