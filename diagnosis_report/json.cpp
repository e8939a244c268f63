#include "diagnosis_report/json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/words.h"
#include "diagnosis_report/explanations.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Diagnosis;
using nlohmann::ordered_json;

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json range(const std::pair<double, double>& ends) {
  return ordered_json::array({number(ends.first), number(ends.second)});
}

/// Logarithm of the ratio wherever there is one, whether or not the feature is compared by it.
ordered_json log_ratio(const diagnosis::GapRow& row) {
  if (row.observed.logarithm) return number(row.difference);
  const bool positive = row.simulated > 0.0 && row.observed.value > 0.0;
  return positive ? number(std::log(row.simulated / row.observed.value)) : ordered_json(nullptr);
}

ordered_json gap_of(const Diagnosis& d) {
  ordered_json rows = ordered_json::array();
  for (const auto& row : d.gap.rows)
    rows.push_back({{"observation", row.observed.observation},
                    {"feature", row.observed.name},
                    {"scale", to_string(row.observed.scale)},
                    {"strain_range", range({row.observed.strain_from, row.observed.strain_to})},
                    {"observed", number(row.observed.value)},
                    {"simulated", number(row.simulated)},
                    {"log_ratio", log_ratio(row)},
                    {"compared_by", row.observed.logarithm ? "ratio" : "difference"},
                    {"difference", number(row.difference)},
                    {"sigma", number(row.sigma)},
                    {"z", number(row.z)},
                    {"significant", row.significant},
                    {"share", number(row.share)}});
  return rows;
}

ordered_json to_json(const diagnosis::Explanation& explanation) {
  ordered_json magnitudes = ordered_json::array(), intervals = ordered_json::array();
  for (const auto& magnitude : explanation.magnitudes) {
    magnitudes.push_back(number(magnitude.mean));
    intervals.push_back(range(magnitude.interval_90));
  }
  const bool any = !magnitudes.empty();
  return {{"id", explanation.id},
          {"name", diagnosis::plain_name(explanation.id)},
          {"sentence", diagnosis::sentence_of(explanation.id)},
          {"in_words", diagnosis::in_words(explanation)},
          {"probability", number(explanation.probability)},
          {"magnitude", any ? magnitudes[0] : ordered_json(nullptr)},
          {"interval_90", any ? intervals[0] : ordered_json::array({nullptr, nullptr})},
          {"unit", explanation.units.empty() ? "" : explanation.units[0]},
          {"magnitudes", magnitudes},
          {"intervals_90", intervals},
          {"units", explanation.units},
          {"misfit", number(explanation.reduced_chi_squared)},
          {"excluded", explanation.excluded},
          {"reason", explanation.reason}};
}

ordered_json hypotheses_of(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (const auto& explanation : d.explanations) all.push_back(to_json(explanation));
  return all;
}

/// Null for what no run was made for, and for the share of what is within the noise.
ordered_json to_json(const diagnosis::Shrinkage& s) {
  const bool made = !s.observations.empty(), closes = made && !s.nothing_to_close;
  const ordered_json unknown = nullptr;
  return {{"before", made ? number(s.before) : unknown},
          {"after", made ? number(s.after) : unknown},
          {"fraction", closes ? number(s.fraction) : unknown},
          {"interval_90", closes ? range(s.interval_90) : ordered_json::array({nullptr, nullptr})},
          {"nothing_to_close", s.nothing_to_close},
          {"observations", s.observations}};
}

ordered_json shrinkage_of(const Diagnosis& d) {
  const bool made = !d.withheld.observations.empty() && !d.withheld.nothing_to_close;
  const ordered_json unknown = nullptr;
  return {{"fitted", to_json(d.fitted)},
          {"withheld", to_json(d.withheld)},
          {"controls",
           {{"modulus_retuned", made ? number(d.retuned) : unknown},
            {"wrong_effect", made && !d.wrong_effect.empty() ? number(d.wrong) : unknown},
            {"wrong_effect_id", d.wrong_effect}}}};
}

ordered_json rows_of(const Eigen::MatrixXd& matrix) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(number(matrix(i, j)));
    rows.push_back(row);
  }
  return rows;
}

ordered_json groups_of(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (const auto& group : d.groups)
    all.push_back({{"effect", group.effect},
                   {"observation", group.group},
                   {"magnitude", number(group.magnitude.mean)},
                   {"interval_90", range(group.magnitude.interval_90)}});
  return all;
}

ordered_json pulls_of(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (const auto& pull : d.pulls)
    all.push_back({{"key", pull.key},
                   {"sigma", number(pull.sigma)},
                   {"pull", number(pull.pull)},
                   {"spread", number(pull.spread)},
                   {"impact", number(pull.impact)}});
  return all;
}

ordered_json law_of(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (const auto& one : d.law)
    all.push_back({{"setting", one.setting}, {"share", number(one.share)}, {"error", number(one.error)}});
  return all;
}

ordered_json places_of(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (const auto& place : d.places) {
    ordered_json ids = ordered_json::array();
    for (std::size_t bead = 0; bead < place.ids.size(); ++bead)
      if (place.stands_out(bead)) ids.push_back(place.ids[bead]);
    all.push_back({{"observation", place.observation},
                   {"strain", number(place.strain)},
                   {"beads", place.ids.size()},
                   {"threshold", number(place.cut)},
                   {"bead_ids", ids},
                   {"words", place.words}});
  }
  return all;
}

ordered_json promise_of(const Diagnosis& d) {
  const auto& p = d.promise;
  const auto replayed = [&](double value) { return p.cases > 0 ? number(value) : ordered_json(nullptr); };
  ordered_json reliability = ordered_json::array(), effects = ordered_json::object();
  for (const auto& bin : p.reliability)
    reliability.push_back(
        {{"said", number(bin.said)}, {"came_true", number(bin.came_true)}, {"cases", bin.cases}});
  for (const auto& [id, effect] : p.effects) {
    ordered_json runs = ordered_json::array();
    for (const auto& run : effect.runs)
      runs.push_back({{"magnitude", number(run.theta)},
                      {"told_from_none", run.told_from_none},
                      {"in_set", run.in_set},
                      {"first", run.first}});
    effects[id] = {
        {"cases", effect.cases},   {"told_from_none", effect.told_from_none}, {"first", effect.first},
        {"in_set", effect.in_set}, {"seen_from", number(effect.seen_from())}, {"runs", runs}};
    const auto [negative, positive] = told_from(d, id);
    if (!std::isnan(negative)) effects[id]["told_from"]["negative"] = number(negative);
    if (!std::isnan(positive)) effects[id]["told_from"]["positive"] = number(positive);
  }
  return {{"cases", p.cases},
          {"confidence", number(p.confidence)},
          {"in_set", replayed(p.in_set)},
          {"set_size", replayed(p.set_size)},
          {"theta_held", replayed(p.theta_held)},
          {"limits_held", replayed(p.limits_held)},
          {"false_alarms", replayed(p.false_alarms)},
          {"outside",
           {{"cases", p.outside.cases}, {"flagged", p.outside.flagged}, {"misnamed", p.outside.misnamed}}},
          {"pairs", {{"cases", p.pairs.cases}, {"in_set", p.pairs.in_set}, {"first", p.pairs.first}}},
          {"temperature", number(p.correction.temperature)},
          {"reliability", reliability},
          {"none", {{"cases", p.none.cases}, {"in_set", p.none.in_set}}},
          {"effects", effects}};
}

ordered_json unseen_of(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (const auto& one : d.unseen)
    all.push_back({{"effect", one.effect},
                   {"name", diagnosis::plain_name(one.effect)},
                   {"limit_95", number(one.limit)},
                   {"unit", one.unit}});
  return all;
}

ordered_json noise_of(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (std::size_t k = 0; k < d.noise.size() && k < d.gap.rows.size(); ++k)
    all.push_back({{"observation", d.gap.rows[k].observed.observation},
                   {"feature", d.gap.rows[k].observed.name},
                   {"ensemble", number(d.noise[k].ensemble)},
                   {"measurement", number(d.noise[k].measurement)},
                   {"model", number(d.noise[k].model)},
                   {"believed", number(d.noise[k].believed)}});
  return all;
}

std::map<std::string, int> runs_by_status(const Diagnosis& d) {
  std::map<std::string, int> counts;
  for (const auto& row : d.ledger) ++counts[row.status];
  return counts;
}

}  // namespace

ordered_json to_json(const diagnosis::Outlook& outlook) {
  ordered_json effects = ordered_json::object();
  for (const auto& [id, effect] : outlook.effects)
    effects[id] = {{"replayed_runs", effect.cases},
                   {"told_from_none", effect.told_from_none},
                   {"named_first", effect.first}};
  return {{"replayed_runs", outlook.cases},
          {"expected_set_size", number(outlook.set_size)},
          {"expected_entropy_bits", number(outlook.entropy)},
          {"probability_settled", number(outlook.settled)},
          {"effects", effects}};
}

ordered_json to_json(const diagnosis::NextSteps& steps) {
  ordered_json all = ordered_json::array();
  for (const auto& next : steps.experiments) {
    const bool known = next.outlook.cases > 0;
    all.push_back({{"observation", next.observation},
                   {"expected_probability_resolved", known ? number(next.outlook.settled) : ordered_json()},
                   {"why", next.why},
                   {"cost", number(next.cost)},
                   {"gain_bits", known ? number(next.gain) : ordered_json()},
                   {"outlook", known ? to_json(next.outlook) : ordered_json()},
                   {"runs_missing", next.runs}});
  }
  return all;
}

ordered_json to_json(const Diagnosis& d) {
  const auto failed =
      std::count_if(d.ledger.begin(), d.ledger.end(), [](const auto& row) { return row.status != "done"; });
  ordered_json json;
  json["experiment"] = d.experiment;
  json["verdict"] = d.verdict;
  json["warnings"] = d.warnings;
  json["gap"] = gap_of(d);
  json["distance"] = number(d.gap.distance);
  json["excess"] = number(d.gap.excess);
  json["noise_floor"] = number(d.gap.noise_floor);
  json["significance_threshold"] = number(d.gap.threshold);
  json["hypotheses"] = hypotheses_of(d);
  json["ambiguity_set"] = d.ambiguity_set;
  json["ambiguity_set_probability"] = number(d.set_probability);
  json["promise"] = promise_of(d);
  json["unseen"] = unseen_of(d);
  json["nearest_signature"] = d.nearest_signature;
  json["goodness"] = number(d.p_value);
  json["shrinkage"] = shrinkage_of(d);
  json["outlook"] = d.next.now.cases > 0 ? to_json(d.next.now) : ordered_json();
  json["next_experiments"] = to_json(d.next);
  json["groups"] = groups_of(d);
  json["pulls"] = pulls_of(d);
  json["law"] = law_of(d);
  json["law_as_stated"] = d.law_as_stated;
  json["specimen_strains"] = d.specimen_strains;
  json["places"] = places_of(d);
  json["separation"] = {{"effects", d.effects}, {"squared_distance", rows_of(d.separation)}};
  json["noise_budget"] = noise_of(d);
  json["runs"] = d.ledger.size();
  json["failed_runs"] = failed;
  json["runs_by_status"] = runs_by_status(d);
  json["provenance"] = pendular::to_json(d.provenance);
  return json;
}

}  // namespace pendular::diagnosis_report
