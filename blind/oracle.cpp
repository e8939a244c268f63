#include "blind/oracle.h"

#include <nlohmann/json.hpp>

#include "base/path_kind.h"
#include "blind/verdict.h"
#include "diagnosis/diagnose.h"

namespace pendular::blind {
namespace {

diagnosis::Changes true_changes(const Truth& truth) {
  return {truth.effects.begin(), truth.effects.end()};
}

std::string oracle_text(const diagnosis::Shrinkage& closed, const Truth& truth) {
  nlohmann::ordered_json json;
  json["effects"] = true_changes(truth);
  json["before"] = closed.before, json["after"] = closed.after;
  json["nothing_to_close"] = closed.nothing_to_close;
  if (closed.nothing_to_close)
    json["fraction"] = nullptr;
  else
    json["fraction"] = closed.fraction, json["interval_90"] = closed.interval_90;
  json["observations"] = closed.observations;
  return json.dump(2) + "\n";
}

}  // namespace

std::vector<std::string> measure_oracles(const CaseFolders& folders, const fs::path& reports,
                                         const fs::path& beads, const diagnosis::MakeRuns& make_runs) {
  std::vector<std::string> measured;
  for (const auto& verdict : verdicts(open_seals(folders.root), reports)) {
    const Truth& truth = verdict.truth;
    const fs::path file = reports / truth.name / kOracle;
    if (truth.effects.empty() || !verdict.said || !verdict.said->withheld || is_there(file)) continue;
    const auto experiment = diagnosis::read_experiment(folders.open(truth.name) / "experiment.toml");
    const auto plan = diagnosis::plan_bank(experiment, {}, beads);
    const auto closed = diagnosis::closed_by(experiment, plan, beads, make_runs, true_changes(truth));
    write_text(file, oracle_text(closed, truth));
    measured.push_back(truth.name);
  }
  return measured;
}

}  // namespace pendular::blind
