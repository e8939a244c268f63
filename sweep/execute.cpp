#include "sweep/execute.h"

#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "run_folder/run_folder.h"
#include "sweep/executors.h"
#include "sweep/longer_runs.h"
#include "sweep/make_run.h"

namespace pendular::sweep {

void OpenRuns::ask() {
  std::size_t done = 0, failed = 0;
  records_.clear();
  const auto found = store_.records(hashes_);
  for (const auto& hash : hashes_) {
    const RunRecord& record = found.at(hash);
    done += record.status == RunStatus::done;
    failed += record.status == RunStatus::failed;
    if (record.status == RunStatus::waiting || record.status == RunStatus::running)
      records_.push_back(record);
  }
  if (options_.progress) options_.progress(done, failed, hashes_.size());
}

namespace {

/// BadInput where a finished run has no result of its own.
void require_result(const Store& store, const std::string& hash) {
  const fs::path file = store.run_folder(hash) / run_file::kResult;
  const auto json = nlohmann::json::parse(read_text(file), nullptr, false);
  const nlohmann::json::json_pointer command("/provenance/command");
  const bool whole = json.is_object() && json.contains("linear_modulus_pa") && json.contains("beads") &&
                     json["beads"].is_number() && json.contains(command) &&
                     json[command] == run_command(hash);
  if (!whole)
    bad_input("{}: is damaged or of another run; remove its folder, and the sweep makes it anew",
              file.string());
}

/// Makes runs, and their outcomes in the order of the requests.
std::vector<RunOutcome> made(Store& store, std::span<const RunRequest> requests,
                             const ExecuteOptions& options) {
  const std::vector<std::string> hashes = store.add(requests);
  std::vector<std::string> once;
  std::set<std::string> seen;
  for (const auto& hash : hashes) {
    if (!seen.insert(hash).second) continue;
    once.push_back(hash);
    if (options.retry_failed) store.retry(hash);
  }
  OpenRuns open(store, once, options);
  if (options.slurm)
    run_on_slurm(store, open, options);
  else
    run_locally(store, open, options);

  const auto records = store.records(once);
  for (const auto& hash : once)
    if (records.at(hash).status == RunStatus::done) require_result(store, hash);
  std::vector<RunOutcome> outcomes;
  for (const auto& hash : hashes) {
    const RunRecord& record = records.at(hash);
    outcomes.push_back({hash, record.status, record.exit_status, record.message, store.run_folder(hash)});
  }
  return outcomes;
}

}  // namespace

std::vector<RunOutcome> execute(Store& store, std::span<const RunRequest> requests,
                                const ExecuteOptions& options) {
  if (!options.rows_suffice) return made(store, requests, options);
  const auto longer = longer_runs(store, requests);
  std::vector<RunRequest> open;
  for (std::size_t k = 0; k < requests.size(); ++k)
    if (!longer[k]) open.push_back(requests[k]);
  const auto outcomes = made(store, open, options);
  auto next = outcomes.begin();
  std::vector<RunOutcome> all;
  for (std::size_t k = 0; k < requests.size(); ++k) {
    if (!longer[k]) {
      all.push_back(*next++);
      continue;
    }
    require_result(store, *longer[k]);
    all.push_back({*longer[k], RunStatus::done, 0, "", store.run_folder(*longer[k]),
                   requests[k].sample.compression.max_strain});
  }
  return all;
}

}  // namespace pendular::sweep
