#include "blind/score_page.h"

#include <fmt/format.h>

#include <cmath>

namespace pendular::blind {
namespace {

std::string share_text(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : "–";
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.2f}", value) : "–";
}

/// "45 of 50, 90 % (79–96 %)".
std::string words(const Proportion& p) {
  if (p.of == 0) return "no case";
  const auto [low, high] = p.interval_95();
  return fmt::format("{} of {}, {} ({:.0f}–{:.0f} %)", p.hits, p.of, share_text(p.share()), 100.0 * low,
                     100.0 * high);
}

/// "84 %; 7 of 9".
std::string words(const Expectation& e) {
  if (e.came.of == 0) return "–";
  return fmt::format("{}; {} of {}", share_text(e.expected), e.came.hits, e.came.of);
}

std::string row(const std::string& what, const std::string& found, const std::string& aim) {
  return fmt::format("| {} | {} | {} |\n", what, found, aim);
}

/// What is promised, by what was observed.
std::string bars_table(const Scores& s) {
  std::string text =
      "| | a curve alone | with Z and lateral strain | with a second specimen, too | aim | with a scan, too "
      "| aim | other engine, no scan | other engine, with a scan |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  const auto line = [&](const char* what, const char* aim, const char* aim_with_scan, const auto& found) {
    const auto of = [&](Observed observed) {
      return found(s.by_observed[static_cast<std::size_t>(observed)]);
    };
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", what, of(Observed::curve),
                        of(Observed::network), of(Observed::second_specimen), aim, of(Observed::scan),
                        aim_with_scan, found(s.other_engine_without_scan), found(s.other_engine_with_scan));
  };
  line("right answer in the set", "≥ 90 %", "≥ 95 %", [](const Bars& b) { return words(b.naming.in_set); });
  line("the same, or `none` where the report says that less is not told", "", "",
       [](const Bars& b) { return words(b.set_is_right); });
  line("what replays expect of the name, and what came", "", "",
       [](const Bars& b) { return words(b.in_set_there); });
  line("mean size of the set", "≤ 2.5", "≤ 1.6", [](const Bars& b) { return number(b.naming.set_size); });
  line("most probable is right, single effects", "≥ 65 %", "≥ 85 %",
       [](const Bars& b) { return words(b.single_first); });
  line("what replays expect, and what came", "", "", [](const Bars& b) { return words(b.first_there); });
  line("pairs in the set", "≥ 60 %", "≥ 80 %", [](const Bars& b) { return words(b.pairs_in_set); });
  line("what replays expect, and what came", "", "", [](const Bars& b) { return words(b.pairs_there); });
  line("outside mechanisms flagged", "≥ 85 %", "≥ 95 %", [](const Bars& b) { return words(b.flagged); });
  line("what replays expect, and what came", "", "", [](const Bars& b) { return words(b.flagged_there); });
  line("outside mechanisms misnamed above 0.9", "≤ 2 %", "≤ 1 %",
       [](const Bars& b) { return words(b.misnamed); });
  line("θ within its 90 % interval", "86–94 %", "86–94 %",
       [](const Bars& b) { return words(b.magnitude.covered); });
  line("median relative error of θ", "≤ 15 %", "≤ 8 %",
       [](const Bars& b) { return share_text(b.magnitude.median_relative_error); });
  text +=
      "\nReplays expect, of the same observations: with nothing or one effect of that sign and nearly that "
      "magnitude withheld, how often its name is in the set, and how often it is first; with two effects, "
      "each told by itself and both responses known, how often the pair is; with an effect that was left out "
      "of the library, how often `unknown` is.\n";
  text += fmt::format(
      "\nEffects too small to be seen, which count nowhere else: `none` or the effect in the set {}; "
      "something else above 0.9 {}.\n",
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
  text += row("median relative error of θ", share_text(s.magnitude.median_relative_error), "≤ 15 %");
  text += row("the same where the effect is named", share_text(s.magnitude_where_named.median_relative_error),
              "");
  text += row("withheld gap closed, median", share_text(s.shrinkage.withheld), "");
  text += row(fmt::format("the same; what the true effects close ({} cases)", s.shrinkage.oracles),
              fmt::format("{}; {}", share_text(s.shrinkage.closed), share_text(s.shrinkage.closable)), "");
  text += row("0.7 and more of what the true effects close", words(s.shrinkage.reached), "");
  text +=
      row("by a retuned modulus; by a wrong effect",
          fmt::format("{}; {}", share_text(s.shrinkage.retuned), share_text(s.shrinkage.wrong_effect)), "");
  text += row("above the retuned modulus, median", share_text(s.shrinkage.above_retuned), "≥ 30 points");
  return text;
}

/// Strata in rows, with all cases as the last one, whose stratum is null.
template <typename Of, typename Cells>
std::string stratum_rows(const std::map<Stratum, Of>& strata, const Of& all, const Cells& cells) {
  std::string text;
  for (const auto& [stratum, of] : strata)
    text += fmt::format("| {} | {} |\n", to_string(stratum), cells(of, &stratum));
  return text + fmt::format("| all | {} |\n", cells(all, nullptr));
}

/// By name and by class side by side.
std::string names_table(const Scores& s) {
  std::string text =
      "| stratum | in the set: by name | by class | set size: by name | by class "
      "| most probable: by name | by class | above 0.9 and wrong: by name | by class |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  text += stratum_rows(s.by_stratum, s.all, [&](const Naming& name, const Stratum* stratum) {
    const Naming& alike = stratum ? s.by_stratum_and_class.at(*stratum) : s.all_by_class;
    return fmt::format("{} | {} | {} | {} | {} | {} | {} | {}", words(name.in_set), words(alike.in_set),
                       number(name.set_size), number(alike.set_size), words(name.exact), words(alike.exact),
                       words(name.confidently_wrong), words(alike.confidently_wrong));
  });
  return text +
         fmt::format(
             "\nBy class, answers count as one with the truth that are nearer to it than {:g} standard "
             "deviations of the noise on the case's own observations, at its magnitude: an ideal observer "
             "could not tell them apart. An effect below the magnitude from which on the report tells it "
             "from "
             "none is one with none. Outside mechanisms are in no class. {} of {} cases have a "
             "diagnosis that states such distances; in the others the name alone counts.\n",
             kTold, s.with_distances, s.all.in_set.of);
}

/// What reports promised beside what came of it.
std::string kept_table(const Scores& s) {
  std::string text =
      "| stratum | in the set: promised | reached | at its magnitude: promised | reached "
      "| set size: promised | reached "
      "| false alarms of `unknown` | θ in its 90 % interval | upper limits that hold "
      "| above 0.9 and wrong |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  text += stratum_rows(s.kept_by_stratum, s.kept, [](const Kept& k, const Stratum*) {
    return fmt::format("{} | {} | {} | {} | {} | {} | {} | {} | {} | {}", share_text(k.promised_in_set),
                       words(k.in_set), share_text(k.there.expected), words(k.there.came),
                       number(k.promised_size), number(k.set_size), words(k.unknown_alarms),
                       words(k.magnitude.covered), words(k.limits), words(k.confidently_wrong));
  });
  return text +
         fmt::format(
             "| aim | | 93–97 %, each stratum ≥ 90 % | | as promised | | | ≤ 5 % | 88–92 % | ≥ 95 % | ≤ 1 % "
             "|\n\n"
             "Promised and reached are of the {} cases that replays stand for: nothing or one effect of the "
             "library withheld, and a bank large enough to promise. In the set is the effect or, below the "
             "magnitude from which on the report tells it from none, `none`; at its magnitude, the effect "
             "alone, by replayed runs of the same effect and sign, the nearer in magnitude the heavier. "
             "Upper "
             "limits are those of effects that are there, hidden ones too, and that the report calls hardly "
             "shown.\n",
             s.kept.promises);
}

/// Said and came true, by stratum.
std::string reliability_table(const Scores& s) {
  std::string head = "| said |", line = "|---|", text;
  const auto add = [&](const std::string& name) { head += fmt::format(" {} |", name), line += "---|"; };
  add("mean"), add("came true, all"), add("by class");
  for (const auto& [stratum, kept] : s.kept_by_stratum) add(to_string(stratum));
  for (std::size_t k = 0; k < s.kept.reliability.size(); ++k) {
    const auto& bin = s.kept.reliability[k];
    text += fmt::format("| {}–{} | {} | {} | {} |", bin.from, bin.to, number(bin.mean_probability),
                        words(bin.right), words(bin.right_by_class));
    for (const auto& [stratum, kept] : s.kept_by_stratum) {
      const auto& own = kept.reliability[k];
      text += own.right.of == 0 ? " – |"
                                : fmt::format(" {} of {}, said {} |", own.right.hits, own.right.of,
                                              number(own.mean_probability));
    }
    text += '\n';
  }
  return head + "\n" + line + "\n" + text +
         "\nThe aim is 0.05 between said and came true in bins of 20 and more cases.\n";
}

std::string answers_table(const Scores& s) {
  std::string text =
      "| right answer | in the set | set size | most probable | confidently wrong | log | Brier |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& [answer, n] : s.by_answer)
    text +=
        fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", answer, words(n.in_set), number(n.set_size),
                    words(n.exact), words(n.confidently_wrong), number(n.log_score), number(n.brier));
  return text;
}

std::string what_was_said(const Verdict& verdict) {
  if (!verdict.said) return "nothing: " + verdict.failure;
  const std::string top = verdict.top();
  return fmt::format("{} with {:.2f}{}, {:.2f} for the right one, which is {}in the set", top,
                     verdict.probability(top),
                     is_right(verdict, top, Counting::by_class) ? " (of its class)" : "",
                     verdict.probability(verdict.answer), verdict.in_set(verdict.answer) ? "" : "not ");
}

std::string wrong_cases(const std::vector<Verdict>& verdicts) {
  std::string text;
  for (const auto& verdict : verdicts)
    if (!verdict.exact())
      text += fmt::format("- {} ({}): {}{}; said {}\n", verdict.truth.name, to_string(verdict.truth.stratum),
                          verdict.answer,
                          verdict.truth.mechanism.empty() ? "" : " (" + verdict.truth.mechanism + ")",
                          what_was_said(verdict));
  return text;
}

}  // namespace

std::string score_page(const std::vector<Verdict>& verdicts, const Scores& s) {
  std::string text =
      fmt::format("# Blind check{}\n\n{} cases, {} without a diagnosis (they count as wrong). ",
                  s.without_truth ? ", true effects left out of the library" : "", s.cases, s.failed);
  text += "Intervals in brackets are 95 %, by Wilson.\n";
  const auto section = [&](const char* heading, const std::string& body) {
    text += fmt::format("\n## {}\n\n{}", heading, body);
  };
  section("By what was observed", bars_table(s));
  section("By name and by class", names_table(s));
  section("Promised and reached", kept_table(s));
  section("Reliability", reliability_table(s));
  section("All scores", aims_table(s));
  section("By right answer", answers_table(s));
  section("Cases whose right answer was not the most probable", wrong_cases(verdicts));
  return text;
}

}  // namespace pendular::blind
