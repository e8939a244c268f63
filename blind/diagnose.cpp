#include "blind/diagnose.h"

#include <algorithm>

#include "base/error.h"
#include "base/path_kind.h"
#include "base/progress.h"
#include "blind/processes.h"
#include "blind/verdict.h"

namespace pendular::blind {
namespace {

std::vector<std::string> case_names(const CaseFolders& folders) {
  const fs::path cases = folders.root / "cases";
  if (!is_folder(cases)) bad_input("{}: no such folder, expected one of cases", cases.string());
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(cases))
    if (is_there(entry.path() / "experiment.toml")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  if (names.empty()) bad_input("{}: found no case, expected folders with experiment.toml", cases.string());
  return names;
}

/// The true effects of a case, as --leave-out wants them.
std::string true_effects(const CaseFolders& folders, const std::string& name) {
  std::string list;
  for (const auto& [id, theta] : read_truth(folders.sealed(name)).effects)
    list += (list.empty() ? "" : ",") + id;
  return list;
}

void check_mode(const DiagnoseRequest& request) {
  if (is_there(request.reports) && !fs::is_empty(request.reports) &&
      without_truth(request.reports) != request.without_truth)
    bad_input("{}: found reports made {} the true effects in the library, expected a folder of their own",
              request.reports.string(), request.without_truth ? "with" : "without");
  make_folder(request.reports);
  if (request.without_truth) mark_without_truth(request.reports);
}

}  // namespace

std::vector<std::string> diagnose_cases(const CaseFolders& folders, const DiagnoseRequest& request) {
  std::vector<std::string> names;
  std::vector<Job> jobs;
  const auto all = case_names(folders);
  check_mode(request);
  for (const auto& name : all) {
    const fs::path report = request.reports / name;
    if (is_there(report / "report.html")) continue;  // its last file
    make_inner_folder(report);
    Job job{request.diagnose.with({(folders.open(name) / "experiment.toml").string(), "-o", report.string(),
                                   "--store", request.store.string()}),
            request.reports / (name + ".log")};
    if (request.without_truth) {
      const std::string effects = true_effects(folders, name);
      if (effects.empty()) continue;
      job.command = job.command.with({"--leave-out", effects});
    }
    job.command = job.command.with(request.options);
    names.push_back(name);
    jobs.push_back(std::move(job));
  }
  Progress progress("blind diagnose", static_cast<double>(jobs.size()));
  std::vector<std::string> failed;
  std::size_t done = 0;
  run_jobs(jobs, 1, [&](std::size_t k, int status) {
    if (status != 0) failed.push_back(fmt::format("{}: {}", names[k], last_line(jobs[k].log)));
    progress.update(static_cast<double>(++done),
                    fmt::format("{} of {} cases, {} failed", done, jobs.size(), failed.size()));
  });
  return failed;
}

}  // namespace pendular::blind
