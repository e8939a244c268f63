#include "binding/runs.h"

#include <algorithm>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "effects/list.h"
#include "sweep/make_run.h"

namespace pendular::python {
namespace {

bool has_added_effect(const sweep::RunRequest& request) {
  const auto& all = effects::all_effects();
  return std::any_of(all.begin(), all.end(), [&](const effects::Effect& effect) {
    return !effect.code.empty() && request.sample.effects.contains(effect.id);
  });
}

void made_here(sweep::Store& store, const std::string& name, std::span<const sweep::RunRequest> requests,
               bool retry_failed) {
  const auto hashes = store.add(requests);
  Progress progress(name, static_cast<double>(hashes.size()));
  for (std::size_t k = 0; k < hashes.size(); ++k) {
    stop_if_interrupted();
    if (retry_failed) store.retry(hashes[k]);
    try {
      sweep::make_run(store, hashes[k]);
    } catch (const Interrupted&) {
      throw;
    } catch (const Error&) {  // the store has it
    }
    progress.update(static_cast<double>(k + 1));
  }
}

}  // namespace

std::vector<sweep::RunOutcome> make_runs(const RunTerms& terms, const std::string& name,
                                         std::span<const sweep::RunRequest> requests) {
  std::vector<sweep::RunRequest> here;
  for (const auto& request : requests)
    if (has_added_effect(request)) here.push_back(request);
  sweep::Store store(terms.store);
  sweep::ExecuteOptions how;
  how.cores = terms.threads;
  how.worker = {terms.program, {"sweep-run"}};
  how.rows_suffice = terms.rows_suffice;
  Progress progress(name, 1.0);
  how.progress = [&](std::size_t done, std::size_t failed, std::size_t total) {
    progress.update(static_cast<double>(done + failed) / static_cast<double>(total),
                    fmt::format("{} of {} runs, {} failed", done + failed, total, failed));
  };
  if (terms.program.empty() && here.size() < requests.size())
    throw ComputationFailed(
        "pendular: the program was not found, which makes runs in processes of their own; expected "
        "it in PATH, or its path in the environment variable PENDULAR_PROGRAM");
  if (here.size() < requests.size()) {
    std::vector<sweep::RunRequest> others;
    for (const auto& request : requests)
      if (!has_added_effect(request)) others.push_back(request);
    how.retry_failed = terms.retry_failed;
    sweep::execute(store, others, how);
  }
  made_here(store, name + ", effects in Python", here, terms.retry_failed);
  how.retry_failed = false;
  return sweep::execute(store, requests, how);  // all are done or failed: their outcomes
}

}  // namespace pendular::python
