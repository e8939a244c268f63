#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "base/error.h"
#include "base/path_kind.h"
#include "base/progress.h"
#include "cli/command.h"
#include "cli/picture_commands.h"
#include "cli/run_making.h"
#include "reproduction/sections.h"
#include "sweep/tables.h"

namespace pendular::cli {
namespace {

using reproduction::Point;
using reproduction::Section;

struct ReproduceOptions {
  Common common;
  RunMaking making;
  fs::path folder;
  int realisations = 0;  ///< at most so many; 0: as the sweep files say
};

constexpr const char* kSweeps[] = {"realisations_a",     "realisations_b", "modulus_of_e_p",
                                   "modulus_of_content", "sensitivity",    "volume_fraction"};

/// The points of the sweep NAME.toml of the folder, its runs made and its tables written; nothing where the
/// folder does not hold it.
std::vector<Point> points_of(const ReproduceOptions& options, const std::string& name,
                             std::vector<std::string>& failed) {
  const fs::path path = options.folder / (name + ".toml");
  if (!is_there(path)) return {};
  sweep::SweepFile file = sweep::read_sweep(path);
  if (options.realisations > 0) file.realisations = std::min(file.realisations, options.realisations);
  const sweep::Plan plan = sweep::plan_of(file);
  const fs::path tables = options.common.out / name;
  make_inner_folder(tables);
  const auto outcomes = make_runs(options.making, options.common, file.name, plan.requests);
  Provenance from = provenance(options.common, {path, file.sample});
  from.seed = file.seed;
  sweep::write_tables(tables, plan, outcomes, from);
  if (const std::string words = failures(outcomes); !words.empty())
    failed.push_back(file.name + ": " + words);
  return reproduction::read_points(plan, outcomes);
}

std::vector<fs::path> inputs_of(const fs::path& folder) {
  std::vector<fs::path> inputs;
  for (const char* name : kSweeps)
    if (const fs::path path = folder / (std::string(name) + ".toml"); is_there(path)) inputs.push_back(path);
  if (inputs.empty())
    bad_input("{}: found no sweep of this name, expected some of {}.toml", folder.string(),
              fmt::join(kSweeps, ".toml, "));
  return inputs;
}

/// The report's sections, of those sweeps that there are.
std::vector<Section> sections_of(const reproduction::Desk& desk, sweep::Store& store,
                                 std::map<std::string, std::vector<Point>>& points) {
  using namespace reproduction;
  std::vector<Section> sections = {bridges_section(desk)};
  std::vector<Point> specimens;
  for (const auto& [name, sweep] : {std::pair("A", "realisations_a"), std::pair("B", "realisations_b")}) {
    if (points[sweep].empty()) continue;
    specimens.push_back(points[sweep].front());
    sections.push_back(specimen_section(desk, name, specimens.back()));
  }
  if (!specimens.empty()) {
    sections.push_back(coordination_section(desk, store, specimens));
    if (const auto size = size_section(specimens.front(), points["modulus_of_e_p"]))
      sections.push_back(*size);
  }
  if (const auto& found = points["modulus_of_e_p"]; !found.empty())
    sections.push_back(stiffness_section(desk, found));
  if (const auto& found = points["modulus_of_content"]; !found.empty())
    sections.push_back(content_section(desk, found));
  if (const auto& found = points["sensitivity"]; !found.empty())
    sections.push_back(sensitivity_section(found));
  if (const auto& found = points["volume_fraction"]; !found.empty())
    sections.push_back(volume_fraction_section(desk, found));
  return sections;
}

void run(const ReproduceOptions& options) {
  cli::apply(options.common, files_in(options.folder));
  check(options.making);
  const Provenance from = provenance(options.common, inputs_of(options.folder));
  const fs::path& out = options.common.out;
  make_folder(out);
  std::vector<std::string> failed;
  std::map<std::string, std::vector<Point>> points;
  for (const char* name : kSweeps) points[name] = points_of(options, name, failed);

  sweep::Store store(options.making.store_folder(options.common));
  const auto sections = sections_of({out, from}, store, points);
  write_text(out / "report.md", reproduction::to_markdown(sections, from));
  if (!failed.empty()) throw ComputationFailed(fmt::format("{}", fmt::join(failed, "; ")));
  say(fmt::format("{} sections in {}", sections.size(), (out / "report.md").string()));
}

}  // namespace

void add_reproduce(CLI::App& app) {
  auto options = std::make_shared<ReproduceOptions>();
  auto* command = add_picture_command(app, "reproduce");
  command->add_option("folder", options->folder, "Folder of sweep files")
      ->required()
      ->check(CLI::ExistingDirectory);
  command
      ->add_option("--realisations", options->realisations, "At most so many of each point, for a quick look")
      ->check(CLI::Range(1, 1000));
  add_run_making(*command, options->making);
  add_common(*command, options->common, "Folder for the report");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
