#include "blind/score_files.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/number_cell.h"
#include "blind/score_page.h"

namespace pendular::blind {
namespace {

using nlohmann::ordered_json;

/// An empty cell for what is not known.
std::string cell(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.6g}", *value) : "";
}

ordered_json json_of(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json json_of(const Proportion& p) {
  const auto [low, high] = p.interval_95();
  return {{"hits", p.hits}, {"of", p.of}, {"share", json_of(p.share())}, {"interval_95", {low, high}}};
}

ordered_json json_of(const Naming& naming) {
  return {{"cases", naming.in_set.of},
          {"set_hit", json_of(naming.in_set)},
          {"mean_set_size", json_of(naming.set_size)},
          {"exact", json_of(naming.exact)},
          {"exact_where_separable", json_of(naming.exact_separable)},
          {"confidently_wrong", json_of(naming.confidently_wrong)},
          {"log_score", json_of(naming.log_score)},
          {"brier", json_of(naming.brier)}};
}

ordered_json json_of(const MagnitudeScore& magnitude) {
  return {{"median_relative_error", json_of(magnitude.median_relative_error)},
          {"covered_by_90", json_of(magnitude.covered)}};
}

ordered_json json_of(const std::vector<ReliabilityBin>& bins) {
  ordered_json all = ordered_json::array();
  for (const auto& bin : bins)
    all.push_back({{"from", bin.from},
                   {"to", bin.to},
                   {"mean_probability", json_of(bin.mean_probability)},
                   {"right", json_of(bin.right)},
                   {"right_by_class", json_of(bin.right_by_class)}});
  return all;
}

ordered_json json_of(const Expectation& of) {
  return {{"expected", json_of(of.expected)}, {"came", json_of(of.came)}};
}

ordered_json json_of(const Kept& kept) {
  return {{"promises", kept.promises},
          {"promised",
           {{"in_set", json_of(kept.promised_in_set)},
            {"set_size", json_of(kept.promised_size)},
            {"theta_held", json_of(kept.promised_theta)},
            {"false_alarms", json_of(kept.promised_alarms)}}},
          {"set_hit", json_of(kept.in_set)},
          {"at_its_magnitude",
           {{"promised", json_of(kept.there.expected)}, {"set_hit", json_of(kept.there.came)}}},
          {"mean_set_size", json_of(kept.set_size)},
          {"false_alarms_of_unknown", json_of(kept.unknown_alarms)},
          {"upper_limits_held", json_of(kept.limits)},
          {"magnitude", json_of(kept.magnitude)},
          {"confidently_wrong", json_of(kept.confidently_wrong)},
          {"reliability", json_of(kept.reliability)}};
}

ordered_json json_of(const Bars& bars) {
  return {{"naming", json_of(bars.naming)},
          {"set_is_right", json_of(bars.set_is_right)},
          {"single_effects_first", json_of(bars.single_first)},
          {"pairs_in_set", json_of(bars.pairs_in_set)},
          {"outside_flagged", json_of(bars.flagged)},
          {"outside_confidently_misnamed", json_of(bars.misnamed)},
          {"magnitude", json_of(bars.magnitude)},
          {"replayed",
           {{"in_set", json_of(bars.in_set_there)},
            {"single_effects_first", json_of(bars.first_there)},
            {"pairs_in_set", json_of(bars.pairs_there)},
            {"outside_flagged", json_of(bars.flagged_there)}}}};
}

ordered_json json_of(const Scores& scores, const Provenance& provenance) {
  ordered_json json;
  json["true_effects_left_out"] = scores.without_truth;
  json["cases"] = scores.cases;
  json["failed"] = scores.failed;
  json["all"] = json_of(scores.all);
  json["all_by_class"] = json_of(scores.all_by_class);
  json["with_distances"] = scores.with_distances;
  json["kept"] = json_of(scores.kept);
  for (const auto& [stratum, naming] : scores.by_stratum) {
    const std::string name = to_string(stratum);
    json["strata"][name] = json_of(naming);
    json["strata_by_class"][name] = json_of(scores.by_stratum_and_class.at(stratum));
    json["kept_by_stratum"][name] = json_of(scores.kept_by_stratum.at(stratum));
  }
  for (const auto& [answer, naming] : scores.by_answer) json["answers"][answer] = json_of(naming);
  json["priors_only"] = {{"log_score", json_of(scores.prior_log_score)},
                         {"brier", json_of(scores.prior_brier)}};
  json["nearest_signature_exact"] = json_of(scores.nearest_signature);
  json["false_alarms"] = json_of(scores.false_alarms);
  json["nothing_withheld_and_not_first"] = json_of(scores.none_not_first);
  json["unknown_flagged"] = json_of(scores.flagged);
  json["unknown_confidently_misnamed"] = json_of(scores.misnamed);
  json["auroc_unknown"] = json_of(scores.auroc_unknown);
  json["magnitude"] = json_of(scores.magnitude);
  json["magnitude_where_named"] = json_of(scores.magnitude_where_named);
  json["shrinkage"] = {{"cases", scores.shrinkage.cases},
                       {"withheld_median", json_of(scores.shrinkage.withheld)},
                       {"modulus_retuned_median", json_of(scores.shrinkage.retuned)},
                       {"wrong_effect_median", json_of(scores.shrinkage.wrong_effect)},
                       {"above_retuned_median", json_of(scores.shrinkage.above_retuned)},
                       {"oracles", scores.shrinkage.oracles},
                       {"true_effects_median", json_of(scores.shrinkage.closable)},
                       {"withheld_median_beside", json_of(scores.shrinkage.closed)},
                       {"reached_0.7_of_that", json_of(scores.shrinkage.reached)}};
  for (std::size_t k = 0; k < kObserved; ++k)
    json["observed"][to_string(static_cast<Observed>(k))] = json_of(scores.by_observed[k]);
  json["other_engine"] = {{"without_scan", json_of(scores.other_engine_without_scan)},
                          {"with_scan", json_of(scores.other_engine_with_scan)}};
  json["hidden"] = {{"none_or_effect_in_set", json_of(scores.hidden.allowed)},
                    {"confidently_misnamed", json_of(scores.hidden.misnamed)}};
  json["provenance"] = to_json(provenance);
  return json;
}

std::string case_row(const Verdict& verdict) {
  const Truth& truth = verdict.truth;
  std::string thetas, set;
  for (const auto& [id, theta] : truth.effects)
    thetas += fmt::format("{}{} {:.4g}", thetas.empty() ? "" : "; ", id, theta);
  if (!truth.mechanism.empty()) thetas = fmt::format("{} {:.4g}", truth.mechanism, truth.mechanism_theta);
  std::string alike;
  for (const auto& id : class_of(verdict)) alike += (alike.empty() ? "" : " ") + id;
  Claim claim;
  std::optional<double> withheld, retuned, wrong, closable;
  if (verdict.said) {
    closable = verdict.said->closable;
    for (const auto& id : verdict.said->set) set += (set.empty() ? "" : " ") + id;
    withheld = verdict.said->withheld, retuned = verdict.said->retuned, wrong = verdict.said->wrong_effect;
    const std::string id = truth.effects.size() == 1 ? truth.effects.front().first : "";
    if (const auto found = verdict.said->claims.find(id); found != verdict.said->claims.end())
      claim = found->second;
  }
  const auto low = claim.interval_90 ? std::optional(claim.interval_90->first) : std::nullopt;
  const auto high = claim.interval_90 ? std::optional(claim.interval_90->second) : std::nullopt;
  std::string failure = verdict.failure;
  for (char& c : failure)
    if (c == ',' || c == '\n') c = ';';
  return fmt::format(
      "{},{},{},{},{},{},{},{},{},{:.4g},{:.4g},{:.4g},{},{},{},{},{},{:.4g},{:.4g},{},{},{},{},{},{},{},{}"
      "\n",
      truth.name, to_string(truth.stratum), verdict.answer, thetas, truth.packing, truth.law,
      truth.wrong_belief, verdict.said ? "done" : "failed", verdict.top(),
      NumberCell{verdict.probability(verdict.top())}, NumberCell{verdict.probability(verdict.answer)},
      NumberCell{verdict.probability("unknown")}, set, alike, verdict.in_set(verdict.answer) ? 1 : 0,
      verdict.exact() ? 1 : 0, verdict.confidently_wrong() ? 1 : 0, NumberCell{log_score(verdict)},
      NumberCell{brier_score(verdict)}, cell(claim.magnitude), cell(low), cell(high), cell(withheld),
      cell(retuned), cell(wrong), cell(closable), failure);
}

std::string cases_csv(const std::vector<Verdict>& verdicts, const Provenance& provenance) {
  std::string text = to_comment(provenance) +
                     "case,stratum,answer,truth,packing,law,wrong_belief,status,top,p_top,p_answer,p_unknown,"
                     "set,class,in_set,exact,"
                     "confidently_wrong,log_score,brier,magnitude,interval_low,interval_high,withheld_closed,"
                     "retuned_closed,wrong_effect_closed,true_effects_close,failure\n";
  for (const auto& verdict : verdicts) text += case_row(verdict);
  return text;
}

}  // namespace

void write_scores(const fs::path& folder, const std::vector<Verdict>& verdicts, const Scores& scores,
                  const Provenance& provenance) {
  make_folder(folder);
  write_text(folder / "cases.csv", cases_csv(verdicts, provenance));
  write_text(folder / "score.json", json_of(scores, provenance).dump(2) + "\n");
  write_text(folder / "score.md", score_page(verdicts, scores));
}

}  // namespace pendular::blind
