#include "blind/score_files.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace pendular::blind {
namespace {

using nlohmann::ordered_json;

/// An empty cell for what is not known.
std::string cell(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.6g}", *value) : "";
}

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : "–";
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.2f}", value) : "–";
}

/// "45 of 50, 90 % (79–96 %)".
std::string words(const Proportion& p) {
  if (p.of == 0) return "no case";
  const auto [low, high] = p.interval_95();
  return fmt::format("{} of {}, {} ({:.0f}–{:.0f} %)", p.hits, p.of, percent(p.share()), 100.0 * low,
                     100.0 * high);
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

ordered_json json_of(const Bars& bars) {
  return {{"naming", json_of(bars.naming)},
          {"single_effects_first", json_of(bars.single_first)},
          {"pairs_in_set", json_of(bars.pairs_in_set)},
          {"outside_flagged", json_of(bars.flagged)},
          {"outside_confidently_misnamed", json_of(bars.misnamed)},
          {"magnitude", json_of(bars.magnitude)}};
}

ordered_json json_of(const Scores& scores, const Provenance& provenance) {
  ordered_json json;
  json["true_effects_left_out"] = scores.without_truth;
  json["cases"] = scores.cases;
  json["failed"] = scores.failed;
  json["all"] = json_of(scores.all);
  for (const auto& [stratum, naming] : scores.by_stratum)
    json["strata"][to_string(stratum)] = json_of(naming);
  for (const auto& [answer, naming] : scores.by_answer) json["answers"][answer] = json_of(naming);
  json["priors_only"] = {{"log_score", json_of(scores.prior_log_score)},
                         {"brier", json_of(scores.prior_brier)}};
  json["nearest_signature_exact"] = json_of(scores.nearest_signature);
  json["false_alarms"] = json_of(scores.false_alarms);
  json["nothing_withheld_and_not_first"] = json_of(scores.none_not_first);
  json["unknown_flagged"] = json_of(scores.flagged);
  json["unknown_confidently_misnamed"] = json_of(scores.misnamed);
  json["auroc_unknown"] = json_of(scores.auroc_unknown);
  for (const auto& bin : scores.reliability)
    json["reliability"].push_back({{"from", bin.from},
                                   {"to", bin.to},
                                   {"mean_probability", json_of(bin.mean_probability)},
                                   {"right", json_of(bin.right)}});
  json["magnitude"] = json_of(scores.magnitude);
  json["magnitude_where_named"] = json_of(scores.magnitude_where_named);
  json["shrinkage"] = {{"cases", scores.shrinkage.cases},
                       {"withheld_median", json_of(scores.shrinkage.withheld)},
                       {"modulus_retuned_median", json_of(scores.shrinkage.retuned)},
                       {"wrong_effect_median", json_of(scores.shrinkage.wrong_effect)},
                       {"above_retuned_median", json_of(scores.shrinkage.above_retuned)}};
  json["without_scan"] = json_of(scores.without_scan);
  json["with_scan"] = json_of(scores.with_scan);
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
  Claim claim;
  std::optional<double> withheld, retuned, wrong;
  if (verdict.said) {
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
      "{},{},{},{},{},{},{},{},{},{:.4g},{:.4g},{:.4g},{},{},{},{},{:.4g},{:.4g},{},{},{},{},{},{},{}\n",
      truth.name, to_string(truth.stratum), verdict.answer, thetas, truth.packing, truth.law,
      truth.wrong_belief, verdict.said ? "done" : "failed", verdict.top(), verdict.probability(verdict.top()),
      verdict.probability(verdict.answer), verdict.probability("unknown"), set,
      verdict.in_set(verdict.answer) ? 1 : 0, verdict.exact() ? 1 : 0, verdict.confidently_wrong() ? 1 : 0,
      log_score(verdict), brier_score(verdict), cell(claim.magnitude), cell(low), cell(high), cell(withheld),
      cell(retuned), cell(wrong), failure);
}

std::string cases_csv(const std::vector<Verdict>& verdicts, const Provenance& provenance) {
  std::string text = to_comment(provenance) +
                     "case,stratum,answer,truth,packing,law,wrong_belief,status,top,p_top,p_answer,p_unknown,"
                     "set,in_set,exact,"
                     "confidently_wrong,log_score,brier,magnitude,interval_low,interval_high,withheld_closed,"
                     "retuned_closed,wrong_effect_closed,failure\n";
  for (const auto& verdict : verdicts) text += case_row(verdict);
  return text;
}

std::string row(const std::string& what, const std::string& found, const std::string& aim) {
  return fmt::format("| {} | {} | {} |\n", what, found, aim);
}

/// What is promised, by what was observed.
std::string bars_table(const Scores& s) {
  const Bars* columns[] = {&s.without_scan, &s.with_scan, &s.other_engine_without_scan,
                           &s.other_engine_with_scan};
  std::string text =
      "| | no scan | aim | with a scan | aim | other engine, no scan | other engine, with a scan |\n"
      "|---|---|---|---|---|---|---|\n";
  const auto line = [&](const char* what, const char* aim, const char* aim_with_scan, const auto& found) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", what, found(*columns[0]), aim,
                        found(*columns[1]), aim_with_scan, found(*columns[2]), found(*columns[3]));
  };
  line("right answer in the set", "≥ 90 %", "≥ 95 %", [](const Bars& b) { return words(b.naming.in_set); });
  line("mean size of the set", "≤ 2.5", "≤ 1.6", [](const Bars& b) { return number(b.naming.set_size); });
  line("most probable is right, single effects", "≥ 65 %", "≥ 85 %",
       [](const Bars& b) { return words(b.single_first); });
  line("pairs in the set", "≥ 60 %", "≥ 80 %", [](const Bars& b) { return words(b.pairs_in_set); });
  line("outside mechanisms flagged", "≥ 85 %", "≥ 95 %", [](const Bars& b) { return words(b.flagged); });
  line("outside mechanisms misnamed above 0.9", "≤ 2 %", "≤ 1 %", [](const Bars& b) { return words(b.misnamed); });
  line("θ within its 90 % interval", "86–94 %", "86–94 %",
       [](const Bars& b) { return words(b.magnitude.covered); });
  line("median relative error of θ", "≤ 15 %", "≤ 8 %",
       [](const Bars& b) { return percent(b.magnitude.median_relative_error); });
  text += fmt::format(
      "\nEffects too small to be seen, which count nowhere else: `none` or the effect in the set {}; something else "
      "above 0.9 {}.\n",
      words(s.hidden.allowed), words(s.hidden.misnamed));
  return text;
}

std::string aims_table(const Scores& s) {
  std::string text = "| score | found | aim |\n|---|---|---|\n";
  text += row("right answer in the set", words(s.all.in_set), "≥ 95 %");
  text += row("mean size of the set", number(s.all.set_size), "≤ 1.6");
  text += row("most probable is right", words(s.all.exact), "");
  text += row("the same where the set has one member", words(s.all.exact_separable), "≥ 90 %");
  text += row("confidently wrong (> 0.9)", words(s.all.confidently_wrong), "≤ 1 %");
  text += row("log score; of the priors alone",
              fmt::format("{}; {}", number(s.all.log_score), number(s.prior_log_score)), "less");
  text += row("Brier score; of the priors alone",
              fmt::format("{}; {}", number(s.all.brier), number(s.prior_brier)), "less");
  text += row("nearest signature is right", words(s.nearest_signature), "");
  text += row("false alarms: nothing withheld, `none` not in the set", words(s.false_alarms), "≤ 5 %");
  text += row("nothing withheld, something else most probable", words(s.none_not_first), "");
  text += row("to be called unknown: `unknown` in the set or first", words(s.flagged), "≥ 80 %");
  text += row("to be called unknown: confidently misnamed", words(s.misnamed), "≤ 2 %");
  text += row("area under the curve of P(unknown)", number(s.auroc_unknown), "");
  text += row("θ within its 90 % interval", words(s.magnitude.covered), "86–94 %");
  text += row("the same where the effect is named", words(s.magnitude_where_named.covered), "");
  text += row("median relative error of θ", percent(s.magnitude.median_relative_error), "≤ 15 %");
  text +=
      row("the same where the effect is named", percent(s.magnitude_where_named.median_relative_error), "");
  text += row("withheld gap closed, median", percent(s.shrinkage.withheld), "≥ 70 % of the closable");
  text += row("by a retuned modulus; by a wrong effect",
              fmt::format("{}; {}", percent(s.shrinkage.retuned), percent(s.shrinkage.wrong_effect)), "");
  text += row("above the retuned modulus, median", percent(s.shrinkage.above_retuned), "≥ 30 points");
  return text;
}

template <typename Key, typename Name>
std::string naming_table(const std::string& head, const std::map<Key, Naming>& rows, const Name& name) {
  std::string text = fmt::format(
      "| {} | in the set | set size | most probable | confidently wrong | log | Brier |\n"
      "|---|---|---|---|---|---|---|\n",
      head);
  for (const auto& [key, n] : rows)
    text +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", name(key), words(n.in_set), number(n.set_size),
                    words(n.exact), words(n.confidently_wrong), number(n.log_score), number(n.brier));
  return text;
}

std::string markdown(const std::vector<Verdict>& verdicts, const Scores& s) {
  std::string text =
      fmt::format("# Blind check{}\n\n{} cases, {} without a diagnosis (they count as wrong). ",
                  s.without_truth ? ", true effects left out of the library" : "", s.cases, s.failed);
  text += "Intervals in brackets are 95 %, by Wilson.\n\n" + bars_table(s) + "\n" + aims_table(s) + "\n";
  text += naming_table("stratum", s.by_stratum, [](Stratum stratum) { return to_string(stratum); }) + "\n";
  text += naming_table("right answer", s.by_answer, [](const std::string& id) { return "`" + id + "`"; });
  text += "\n| probability of the most probable | mean | right |\n|---|---|---|\n";
  for (const auto& bin : s.reliability)
    text += fmt::format("| {}–{} | {} | {} |\n", bin.from, bin.to, number(bin.mean_probability),
                        words(bin.right));
  text += "\nCases whose right answer was not the most probable:\n\n";
  for (const auto& verdict : verdicts)
    if (!verdict.exact())
      text += fmt::format(
          "- {} ({}): {}{}; said {}\n", verdict.truth.name, to_string(verdict.truth.stratum), verdict.answer,
          verdict.truth.mechanism.empty() ? "" : " (" + verdict.truth.mechanism + ")",
          verdict.said
              ? fmt::format("{} with {:.2f}, {:.2f} for the right one, which is {}in the set", verdict.top(),
                            verdict.probability(verdict.top()), verdict.probability(verdict.answer),
                            verdict.in_set(verdict.answer) ? "" : "not ")
              : "nothing: " + verdict.failure);
  return text;
}

}  // namespace

void write_scores(const fs::path& folder, const std::vector<Verdict>& verdicts, const Scores& scores,
                  const Provenance& provenance) {
  make_folder(folder);
  write_text(folder / "cases.csv", cases_csv(verdicts, provenance));
  write_text(folder / "score.json", json_of(scores, provenance).dump(2) + "\n");
  write_text(folder / "score.md", markdown(verdicts, scores));
}

}  // namespace pendular::blind
