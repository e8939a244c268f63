// Every run of a bank diagnosed as if it had been measured (docs/diagnose-method.md, step 8): a row each, and
// what the replay promises and takes; and how much of what a reading of the law does to all members it does
// to each of them.
//
//   replay_bench EXPERIMENT.toml STORE > replayed.csv
//
// Its runs must be in STORE (pendular diagnose). Where an effect was left out of the library, `unknown` is
// right.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "bench/stored_bank.h"
#include "diagnosis/bank/law_readings.h"
#include "diagnosis/inference/calibration.h"
#include "diagnosis/inference/judgement.h"
#include "diagnosis/inference/problem.h"
#include "diagnosis/thresholds.h"

namespace {

using namespace pendular;
using namespace pendular::diagnosis;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double probability(const std::vector<Hypothesis>& said, const std::string& id) {
  for (const auto& h : said)
    if (h.id == id) return h.probability;
  return 0.0;
}

/// Shares of a law's mean response that each member's run shows, as pulls do.
void tell_laws(const Problem& problem) {
  const auto& inputs = problem.readings.inputs;
  for (const auto& law : law_readings()) {
    const auto column = std::find(inputs.begin(), inputs.end(), law.name) - inputs.begin();
    std::string shares;
    for (const auto& run : problem.design.runs)
      for (const auto& as_believed : problem.design.runs) {
        if (run.id != law.id || !as_believed.id.empty() || as_believed.member != run.member) continue;
        const Eigen::VectorXd pulls = pulls_of(problem.readings.gap, run.values - as_believed.values);
        if (column < pulls.size()) shares += fmt::format(" {:.2f}", kThresholds.law_reading * pulls[column]);
      }
    std::cerr << fmt::format("{}:{}\n", law.name, shares);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::cerr << "replay_bench EXPERIMENT.toml STORE\n";
    return 2;
  }
  const Experiment experiment = read_experiment(words[1]);
  const bench::StoredBank bank(experiment, words[2]);
  double start = seconds();
  const Problem problem = problem_of(experiment, bank.plan, bank.tests);
  std::cerr << fmt::format("{} features, problem in {:.1f} s\n", problem.readings.observed.features.size(),
                           seconds() - start);
  tell_laws(problem);
  const Rules rules;
  std::vector<Replayed> replayed;
  for (const Replays what : {Replays::runs, Replays::all}) {
    start = seconds();
    replayed = replay(experiment, bank.plan, *problem.features, rules.priors, rules.draws, what);
    std::cerr << fmt::format("{} runs replayed in {:.1f} s\n", replayed.size(), seconds() - start);
  }
  start = seconds();
  const Promise promise = promise_of(replayed, rules.confidence);
  std::cerr << fmt::format(
      "promised in {:.1f} s: in the set {:.3f} at {:.2f}, theta {:.2f}, false alarms {:.3f}, temperature {}, "
      "gate {:.3f}; of {} left out {} flagged, {} misnamed; of {} pairs {} in the set, {} first\n",
      seconds() - start, promise.in_set, promise.set_size, promise.theta_held, promise.false_alarms,
      promise.correction.temperature, promise.correction.gate, promise.outside.cases, promise.outside.flagged,
      promise.outside.misnamed, promise.pairs.cases, promise.pairs.in_set, promise.pairs.first);
  for (const auto& bin : promise.reliability)
    std::cerr << fmt::format("said {:.2f} came true {:.2f} of {}\n", bin.said, bin.came_true, bin.cases);
  std::cout << "member,truth,theta,left_out,top,p_top,p_truth,p_none,p_unknown,chi_squared_top,set\n";
  for (const auto& one : replayed) {
    const auto said = corrected(one.said, promise.of_replayed);
    const auto set = set_of(said, promise.of_replayed);
    std::string ids;
    for (const auto& id : set.ids) ids += (ids.empty() ? "" : " ") + id;
    const double theta = one.truth.empty() ? 0.0 : one.truth.begin()->second;
    const auto& top = said.front();
    std::cout << fmt::format("{},{},{:.6g},{},{},{:.4f},{:.4g},{:.4g},{:.4g},{:.2f},{}\n", one.member,
                             truth_of(one), theta, one.left_out, top.id, top.probability,
                             probability(said, truth_of(one)), probability(said, "none"),
                             probability(said, "unknown"), top.chi_squared, ids);
  }
}
