#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "blind/diagnose.h"
#include "blind/make.h"
#include "blind/oracle.h"
#include "blind/score_files.h"
#include "cli/command.h"
#include "cli/own_program.h"
#include "cli/run_making.h"

namespace pendular::cli {
namespace {

struct MakeOptions {
  Common common;
  fs::path file;
  bool seed_given = false, dry_run = false;
  std::size_t packing = 0;  // from 1; 0: all

  blind::Split split() const {
    return blind::read_split(file, seed_given ? std::optional(common.seed) : std::nullopt);
  }
};

void make(const MakeOptions& options) {
  apply(options.common, {options.file});
  const blind::Split split = options.split();
  if (options.packing > split.packings.size())
    throw BadUsage(fmt::format("--packing: found {}, expected at most {}, the packings of {}",
                               options.packing, split.packings.size(), options.file.string()));
  const blind::CaseFolders folders{options.common.out};
  const std::string ahead = blind::work_ahead(folders, split, options.packing, thread_count());
  if (options.dry_run) return say(ahead);
  make_folder(folders.root);
  say(ahead);
  const std::size_t cases =
      blind::make_split(folders, split, options.packing, thread_count(), [&](std::size_t number) {
        return Command{own_program(),
                       {"blind-case", options.file.string(), std::to_string(number), "--seed",
                        std::to_string(split.seed), "--threads", "1", "-o", options.common.out.string()}};
      });
  say(fmt::format("{}: {} cases in {}, their truth in {}", split.name, cases,
                  (folders.root / "cases").string(), (folders.root / "sealed").string()));
}

struct CaseOptions {
  MakeOptions make;
  std::size_t number = 0;
};

void make_one(const CaseOptions& options) {
  apply(options.make.common, {options.make.file});
  const blind::Split split = options.make.split();
  const auto plans = blind::plan_of(split);
  if (options.number >= plans.size())
    throw BadUsage(fmt::format("blind-case: found {}, expected less than {}", options.number, plans.size()));
  blind::make_case({options.make.common.out}, split, plans[options.number]);
}

void add_blind_make(CLI::App& blind) {
  auto options = std::make_shared<MakeOptions>();
  auto* command = blind.add_subcommand(
      "make",
      "Makes experiments whose truth is known and sealed: DIR/cases/NAME holds what a diagnosis may\n"
      "read and the SHA-256 of DIR/sealed/NAME.json, which holds the truth. The same command goes on\n"
      "where it stopped.");
  command->add_option("file", options->file, "Split file (.toml)")->required();
  command->add_option("--packing", options->packing, "Only the cases on this packing of the split, from 1")
      ->check(CLI::Range(1, 1000));
  command->add_flag("--dry-run", options->dry_run, "Say how many cases there are and how long they take");
  command->add_flag("--resume")->description("Go on where it stopped; it does so anyway");
  add_common(*command, options->common, "Folder for the cases");
  command->callback([options, command] {
    options->seed_given = command->count("--seed") > 0;
    make(*options);
  });
}

struct DiagnoseOptions {
  Common common;
  fs::path folder;
  blind::DiagnoseRequest request;
};

void diagnose(DiagnoseOptions options, std::vector<std::string> further) {
  apply(options.common, {});
  further.insert(further.end(), {"--threads", std::to_string(options.common.threads), "--seed",
                                 std::to_string(options.common.seed)});
  options.request.reports = options.common.out;
  options.request.diagnose = {own_program(), {"diagnose"}};
  options.request.options = std::move(further);
  if (options.request.store.empty()) options.request.store = options.common.out / "store";
  const auto failed = blind::diagnose_cases({options.folder}, options.request);
  if (!failed.empty())
    throw ComputationFailed(fmt::format("{} cases could not be diagnosed; {}{}", failed.size(),
                                        failed.front(), failed.size() > 1 ? "; …" : ""));
}

void add_blind_diagnose(CLI::App& blind) {
  auto options = std::make_shared<DiagnoseOptions>();
  auto* command = blind.add_subcommand(
      "diagnose",
      "Runs `pendular diagnose` on every case of DIR/cases that has no report yet, one after the other.\n"
      "Options that are not listed here are passed on to it. DIR/sealed need not be there.");
  command->add_option("folder", options->folder, "Folder of `pendular blind make`")->required();
  command->add_option("--store", options->request.store,
                      "Folder of runs, which the cases share; default: OUT/store");
  command->add_flag("--without-truth", options->request.without_truth,
                    "Leave each case's true effects out of the library: `unknown` is then right. Reads\n"
                    "DIR/sealed");
  command->allow_extras();
  add_common(*command, options->common, "Folder for the reports");
  command->callback([options, command] { diagnose(*options, command->remaining()); });
}

struct OracleOptions {
  Common common;
  RunMaking making;
  fs::path folder;
};

void oracle(const OracleOptions& options) {
  apply(options.common, {});
  check(options.making);
  const fs::path beads = options.making.store_folder(options.common) / "measured";
  const auto measured =
      blind::measure_oracles({options.folder}, options.common.out, beads,
                             [&](const std::string& name, std::span<const sweep::RunRequest> requests) {
                               return make_runs(options.making, options.common, name, requests);
                             });
  say(fmt::format("{} cases: what their true effects close", measured.size()));
}

void add_blind_oracle(CLI::App& blind) {
  auto options = std::make_shared<OracleOptions>();
  options->making.rows_suffice = true;
  auto* command = blind.add_subcommand(
      "oracle",
      "Measures what the true effects of each case close of the gap, for reports that say how far it\n"
      "shrinks: REPORTS/NAME/oracle.json, which `score` sets beside what was closed. Opens the sealed "
      "truth.");
  command->add_option("folder", options->folder, "Folder of `pendular blind make`")->required();
  add_run_making(*command, options->making);
  add_common(*command, options->common, "Folder of `pendular blind diagnose`");
  command->callback([options] { oracle(*options); });
}

struct ScoreOptions {
  Common common;
  fs::path folder, reports;
};

void score(const ScoreOptions& options) {
  apply(options.common, {});
  const auto truths = blind::open_seals(options.folder);
  const auto verdicts = blind::verdicts(truths, options.reports);
  if (verdicts.empty()) bad_input("{}: found no case to score", options.folder.string());
  const auto scores = blind::score(verdicts, blind::without_truth(options.reports));
  blind::write_scores(options.common.out, verdicts, scores,
                      provenance(options.common, {blind::CaseFolders{options.folder}.seals()}));
  say(fmt::format("{} cases, {} without a diagnosis: {}", scores.cases, scores.failed,
                  (options.common.out / "score.md").string()));
}

void add_blind_score(CLI::App& blind) {
  auto options = std::make_shared<ScoreOptions>();
  auto* command = blind.add_subcommand(
      "score",
      "Opens the sealed truth of DIR's cases, checks it against the published hashes, and scores the\n"
      "reports REPORTS/NAME/diagnosis.json: score.md, score.json, cases.csv. Cases without a report count\n"
      "as wrong.");
  command->add_option("folder", options->folder, "Folder of `pendular blind make`")->required();
  command->add_option("reports", options->reports, "Folder of `pendular blind diagnose`")->required();
  add_common(*command, options->common, "Folder for the scores");
  command->callback([options] { score(*options); });
}

}  // namespace

void add_blind(CLI::App& app) {
  auto* command = app.add_subcommand("blind", "Checks of `pendular diagnose` with the effect withheld");
  command->require_subcommand(1);
  add_blind_make(*command);
  add_blind_diagnose(*command);
  add_blind_oracle(*command);
  add_blind_score(*command);
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
