// Whether advice settles: from one compression curve, runs of a bank are taken for the truth, the best or the
// worst of the ranked measurements is made, twice, and the set is looked at.
//
//   advice_bench EXPERIMENT.toml STORE PENDULAR [RUNS]
//
// EXPERIMENT's first compression curve alone is known at the start; its runs must be in STORE (pendular
// diagnose). Those of scans at 1 and 2 % are made there, as a diagnosis does, by the program PENDULAR;
// measurements that need longer runs are not offered.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>

#include "bench/stored_bank.h"
#include "diagnosis/advice/next_experiments.h"
#include "diagnosis/experiment/further_measurements.h"
#include "diagnosis/inference/calibration.h"
#include "diagnosis/inference/judgement.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"
#include "sweep/execute.h"

namespace {

using namespace pendular;
using namespace pendular::diagnosis;

constexpr int kSteps = 2;

/// A curve, and what was measured after it.
struct State {
  Experiment experiment;
  std::set<std::string> known;  ///< effects that were found or ruled out directly
  std::string key;
};

/// What one of the runs comes to.
struct Outcome {
  AmbiguitySet set;
  Question question;
  std::map<std::string, ToldFrom> told_from;
  bool settled = false;

  /// Whether the set is one explanation, and the right one: the effect or, where so little is not told, none.
  bool right(const std::string& effect, double theta) const {
    if (set.ids.size() != 1) return false;
    const auto from = told_from.find(effect);
    const bool told = from == told_from.end() || from->second.tells(theta);
    return set.ids.front() == effect || (!told && set.ids.front() == kNone);
  }
};

class Bench {
 public:
  Bench(Experiment curve, const fs::path& store, const fs::path& program)
      : curve_(std::move(curve)), bank_(curve_, store), store_(store) {
    how_.worker = {program, {"sweep-run"}};
    how_.rows_suffice = true;
    for (const auto& effect : effects::all_effects())
      if (!bank_.plan.absent.contains(effect.id)) effects_.insert(effect.id);
  }

  State start() const { return {curve_, {}, ""}; }

  /// All runs, diagnosed with what a state knows.
  const std::vector<Replayed>& replayed(const State& state) {
    auto& found = kept_[state.key];
    if (found.empty())
      found =
          knowing(replayed_with(hand(state), state.experiment, effects_, "state", bank_.ledger), state.known);
    return found;
  }

  Outcome diagnosed(const State& state, std::size_t run) {
    const auto& all = replayed(state);
    const Correction correction = promise_of(all, kConfidence).of_replayed;
    const auto said = corrected(all[run].said, correction);
    const AmbiguitySet set = set_of(said, correction);
    Diagnosis diagnosis;
    diagnosis.ambiguity_set = set.ids;
    for (const auto& h : said) diagnosis.explanations.push_back({h.id, h.probability, h.magnitudes, {}});
    return {set, question_after(diagnosis), correction.told_from, is_settled(diagnosis)};
  }

  /// The state after the best measurement, or the worst that is ranked; nothing where none is.
  std::optional<State> advised(const State& state, const Question& question, bool best) {
    const NextSteps steps = next_steps(hand(state), question, bank_.ledger);
    std::vector<NextExperiment> ranked;
    for (const auto& next : steps.experiments)
      if (next.outlook.cases > 0) ranked.push_back(next);
    if (ranked.empty()) return std::nullopt;
    const std::string name = best ? ranked.front().observation : ranked.back().observation;
    for (const auto& measurement : further_measurements()) {
      if (measurement.name != name) continue;
      State after = state;
      after.key += name + ";";
      if (measurement.added)
        after.experiment = *measurement.added(state.experiment);
      else
        after.known.insert(measurement.settles.begin(), measurement.settles.end());
      return after;
    }
    return std::nullopt;
  }

 private:
  static constexpr double kConfidence = 0.95;

  BankInHand hand(const State& state) {
    return {state.experiment, bank_.plan,  bank_.tests,
            bank_.packings,   &make_runs_, kThresholds.short_test,
            Priors{},         kConfidence, 1};
  }

  Experiment curve_;
  bench::StoredBank bank_;
  sweep::Store store_;
  sweep::ExecuteOptions how_;
  MakeRuns make_runs_ = [this](const std::string&, std::span<const sweep::RunRequest> requests) {
    return sweep::execute(store_, requests, how_);
  };
  std::set<std::string> effects_;
  std::map<std::string, std::vector<Replayed>> kept_;
};

}  // namespace

int main(int count, char** words) {
  if (count < 4) {
    std::cerr << "advice_bench EXPERIMENT.toml STORE PENDULAR [RUNS]\n";
    return 2;
  }
  Experiment experiment = read_experiment(words[1]);
  experiment.observations.resize(1);
  Bench bench(experiment, words[2], words[3]);
  const std::size_t wanted = count > 4 ? std::stoul(words[4]) : 24;
  const auto start = bench.start();
  const std::size_t runs = bench.replayed(start).size();
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < runs; ++k)
    if (!bench.replayed(start)[k].truth.empty() && bench.diagnosed(start, k).set.ids.size() > 1)
      open.push_back(k);
  std::cout << fmt::format("{} of {} runs are open after one curve\n", open.size(), runs);
  std::cout << "| advice | runs | set of one | it is right | mean size |\n|---|---|---|---|---|\n";
  for (const bool best : {true, false}) {
    double single = 0.0, right = 0.0, size = 0.0, taken = 0.0;
    for (std::size_t n = 0; n < std::min(wanted, open.size()); ++n) {
      const std::size_t run = open[n * open.size() / std::min(wanted, open.size())];
      State state = start;
      Outcome outcome = bench.diagnosed(state, run);
      for (int step = 0; step < kSteps && !outcome.settled; ++step) {
        auto after = bench.advised(state, outcome.question, best);
        if (!after || bench.replayed(*after).size() != runs) break;
        state = std::move(*after);
        outcome = bench.diagnosed(state, run);
      }
      const auto& [truth, theta] = *bench.replayed(start)[run].truth.begin();
      const auto& set = outcome.set.ids;
      taken += 1.0, size += static_cast<double>(set.size());
      single += set.size() == 1;
      right += outcome.right(truth, theta);
      std::cerr << fmt::format("{} {}: {} after {}\n", best ? "best" : "worst", truth, fmt::join(set, " "),
                               state.key);
    }
    std::cout << fmt::format("| {} | {:.0f} | {:.0f} | {:.0f} | {:.2f} |\n", best ? "best" : "worst", taken,
                             single, right, size / taken);
  }
}
