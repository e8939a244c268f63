#include "cli/command.h"

#include <set>

#include "base/parallel.h"
#include "base/progress.h"
#include "cli/option_checks.h"

namespace pendular::cli {
namespace {

std::vector<std::string> command_line;

/// The command as typed, without what cannot change the result, so that equal work has equal provenance.
std::string canonical_command() {
  static const std::set<std::string> with_value = {"--threads", "--out",      "-o",
                                                   "--store",   "--executor", "--slurm-options"};
  static const std::set<std::string> alone = {"--quiet", "--resume", "--retry-failed"};
  std::string text = "pendular";
  for (std::size_t k = 0; k < command_line.size(); ++k) {
    const std::string name = command_line[k].substr(0, command_line[k].find('='));
    if (alone.count(name)) continue;
    if (with_value.count(name)) {
      if (name == command_line[k]) ++k;
      continue;
    }
    text += ' ' + command_line[k];
  }
  return text;
}

}  // namespace

void set_command_line(const std::vector<std::string>& words) {
  command_line = words;
}

void add_common(CLI::App& command, Common& common, const std::string& out_help,
                const std::string& out_default) {
  command
      .add_option("--threads", common.threads, "Threads to use; 0: one per core. Results do not depend on it")
      ->check(CLI::Range(0, 4096));
  command.add_option("--seed", common.seed, "Seed of everything random")->check(whole_number());
  command.add_flag("--quiet", common.quiet, "Say nothing but warnings and errors");
  common.out = out_default;
  auto* out = command.add_option("-o,--out", common.out, out_help);
  if (out_default.empty())
    out->required();
  else
    out->capture_default_str();
}

void apply(const Common& common, const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  set_threads(common.threads);
  set_quiet(common.quiet);
  protect_inputs(inputs);
  require_outputs(outputs);
  for (const auto& path : outputs) require_writable(path);
}

fs::path beside(const fs::path& out, const char* extension) {
  return fs::path(out).replace_extension(extension);
}

Provenance provenance(const Common& common, const std::vector<fs::path>& inputs) {
  Provenance result;
  result.version = program_version();
  result.command = canonical_command();
  result.seed = common.seed;
  for (const auto& input : inputs) result.add_input(input);
  return result;
}

}  // namespace pendular::cli
