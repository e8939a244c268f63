#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "blind/make.h"
#include "cli/command.h"

namespace pendular::cli {
namespace {

struct MakeOptions {
  Common common;
  fs::path file;
  bool seed_given = false, dry_run = false;

  blind::Split split() const {
    return blind::read_split(file, seed_given ? std::optional(common.seed) : std::nullopt);
  }
};

void make(const MakeOptions& options) {
  apply(options.common);
  const blind::Split split = options.split();
  const blind::CaseFolders folders{options.common.out};
  if (options.dry_run) return say(blind::work_ahead(folders, split, thread_count()));
  make_folder(folders.root);
  say(blind::work_ahead(folders, split, thread_count()));
  blind::make_split(folders, split, thread_count(), [&](std::size_t number) {
    return std::vector<std::string>{"blind-case",
                                    options.file.string(),
                                    std::to_string(number),
                                    "--seed",
                                    std::to_string(split.seed),
                                    "--threads",
                                    "1",
                                    "-o",
                                    options.common.out.string()};
  });
  say(fmt::format("{}: {} cases in {}, their truth in {}", split.name, split.cases,
                  (folders.root / "cases").string(), (folders.root / "sealed").string()));
}

struct CaseOptions {
  MakeOptions make;
  std::size_t number = 0;
};

void make_one(const CaseOptions& options) {
  apply(options.make.common);
  const blind::Split split = options.make.split();
  const auto plans = blind::plan_of(split);
  if (options.number >= plans.size())
    throw BadUsage(fmt::format("blind-case: found {}, expected less than {}", options.number, plans.size()));
  blind::make_case({options.make.common.out}, split, plans[options.number]);
}

void add_make(CLI::App& blind) {
  auto options = std::make_shared<MakeOptions>();
  auto* command = blind.add_subcommand(
      "make",
      "Makes experiments whose truth is known and sealed: DIR/cases/NAME holds what a diagnosis may\n"
      "read and the SHA-256 of DIR/sealed/NAME.json, which holds the truth. The same command goes on\n"
      "where it stopped.");
  command->add_option("file", options->file, "Split file (.toml)")->required();
  command->add_flag("--dry-run", options->dry_run, "Say how many cases there are and how long they take");
  command->add_flag("--resume")->description("Go on where it stopped; it does so anyway");
  add_common(*command, options->common, "Folder for the cases");
  command->callback([options, command] {
    options->seed_given = command->count("--seed") > 0;
    make(*options);
  });
}

}  // namespace

void add_blind(CLI::App& app) {
  auto* command = app.add_subcommand("blind", "Checks of `pendular diagnose` with the effect withheld");
  command->require_subcommand(1);
  add_make(*command);
}

void add_blind_case(CLI::App& app) {
  auto options = std::make_shared<CaseOptions>();
  auto* command = app.add_subcommand("blind-case", "Makes one case of a split")->group("");
  command->add_option("file", options->make.file)->required();
  command->add_option("number", options->number)->required();
  add_common(*command, options->make.common, "Folder for the cases");
  command->callback([options, command] {
    options->make.seed_given = command->count("--seed") > 0;
    make_one(*options);
  });
}

}  // namespace pendular::cli
