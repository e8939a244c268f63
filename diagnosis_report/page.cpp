#include "diagnosis_report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/quantity.h"
#include "diagnosis/advice/next_experiments.h"
#include "diagnosis/words.h"
#include "diagnosis_report/explanations.h"
#include "diagnosis_report/place_figures.h"
#include "diagnosis_report/tables.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Diagnosis;

constexpr std::size_t kLongestLedger = 400;  // rows of the ledger in the page

std::size_t not_made(const Diagnosis& d) {
  return static_cast<std::size_t>(
      std::count_if(d.ledger.begin(), d.ledger.end(), [](const auto& row) { return row.status != "done"; }));
}

/// The short list after the verdict; what it says already is not repeated.
std::vector<viz::ReportRow> figures_of(const Diagnosis& d) {
  std::vector<viz::ReportRow> rows;
  for (const auto& id : d.ambiguity_set)
    for (const auto& e : d.explanations)
      if (e.id == id)
        rows.push_back({"Possible cause: " + diagnosis::in_words(e), percent(e.probability), ""});
  if (d.ambiguity_set.size() > 1) rows.push_back({"These together", percent(d.set_probability), ""});
  const auto significant =
      std::count_if(d.gap.rows.begin(), d.gap.rows.end(), [](const auto& row) { return row.significant; });
  rows.push_back(
      {"Features that differ significantly", fmt::format("{} of {}", significant, d.gap.rows.size()), ""});
  rows.push_back({"Gap beyond the noise, over the noise", rounded(d.gap.excess), ""});
  rows.push_back({"Noise of what is compared by ratio, median", percent(d.gap.noise_floor), ""});
  rows.push_back({"p-value of the best explanation", percent(d.p_value), ""});
  rows.push_back({"Simulated tests", std::to_string(d.ledger.size()), ""});
  if (not_made(d) > 0) rows.push_back({"of which failed or not made", std::to_string(not_made(d)), ""});
  return rows;
}

viz::ReportSection section(const std::string& heading, const std::string& text,
                           const std::vector<viz::ReportPicture>& pictures) {
  return {heading, text, {}, pictures};
}

viz::ReportSection where_section(const Diagnosis& d, const Pictures& pictures) {
  auto out = section("Where the gap lies", d.gap.rows.empty() ? "No features could be compared." : "",
                     pictures.where);
  for (const auto& place : d.places) out.specimens.push_back(place_view(place));
  if (d.gap.rows.empty()) return out;
  out.tables = {
      to_report(shown_share_table(d), "Share of the gap by scale and by observation."),
      to_report(shown_gap_table(d),
                "Every feature. Difference: simulated over observed less one where compared by ratio, else "
                "simulated less observed; sigma is its standard deviation; * significant.")};
  return out;
}

viz::ReportSection which_section(const Diagnosis& d, const Pictures& pictures) {
  std::string text;
  for (const auto& id : d.ambiguity_set)
    text += fmt::format("{}: {}\n", diagnosis::name_and_id(id), diagnosis::sentence_of(id));
  auto out = section("Which effect", text, pictures.which);
  out.tables = {to_report(shown_hypothesis_table(d), "Explanations, most probable first.")};
  return out;
}

viz::ReportSection excluded_section(const Diagnosis& d) {
  const Table table = shown_excluded_table(d);
  auto out = section("Excluded effects", table.rows.empty() ? "None is excluded." : "", {});
  if (!table.rows.empty()) out.tables = {to_report(table, "")};
  return out;
}

viz::ReportSection budget_section(const Diagnosis& d) {
  const Table table = noise_table(d);
  auto out = section("Uncertainty budget",
                     "Standard deviations of each feature's difference: between realisations, of the "
                     "measurement, of the model of effects, and of what is believed of the specimens.",
                     {});
  if (!table.rows.empty()) out.tables = {to_report(table, "")};
  return out;
}

viz::ReportSection promise_section(const Diagnosis& d) {
  const auto& p = d.promise;
  if (p.cases == 0)
    return section("What this can promise",
                   "The bank is too small to be replayed: probabilities and sets are widened by rule, not by "
                   "what runs show.",
                   {});
  std::string text = fmt::format(
      "{} simulated runs of known truth were diagnosed as if they had been measured, each by a bank without "
      "its member. The set held the truth, or none for an effect too small to be told from it, in {} of them "
      "(asked for: {} of measured experiments, which are missed more often than replayed runs), with {} "
      "members on average and something not in the library among them in {}; 90 % intervals held the "
      "magnitude in {}.",
      p.cases, percent(p.in_set), percent(p.confidence), rounded(p.set_size), percent(p.false_alarms),
      percent(p.theta_held));
  if (p.outside.cases > 0)
    text += fmt::format(
        " Of {} runs whose effect the library was made to lack, as it lacks other mechanisms, {} were "
        "flagged as "
        "unknown and {} named something else with more than 0.9.",
        p.outside.cases, p.outside.flagged, p.outside.misnamed);
  if (p.pairs.cases > 0)
    text += fmt::format(
        " Of {} pairs of effects that were put together from these runs, each effect large enough to be told "
        "by itself, {} were in the set and {} named first.",
        p.pairs.cases, p.pairs.in_set, p.pairs.first);
  auto out = section("What this can promise", text, {});
  if (!d.unseen.empty())
    out.tables.push_back(to_report(
        shown_unseen_table(d),
        "Hardly shown by these observations: effects that may be there, and the largest magnitude that could "
        "hide (95 %)."));
  out.tables.push_back(
      to_report(shown_promise_table(d),
                "Replayed runs of each effect: shares told from none, named first, and answered by "
                "a right set; magnitudes, below zero and above, from which on half of the runs are "
                "told from none, which stands for smaller ones; and the magnitude from which on "
                "nine in ten are told (empty: at none of the bank)."));
  out.tables.push_back(to_report(shown_reliability_table(d),
                                 "How often the most probable explanation of a replayed run was right."));
  return out;
}

viz::ReportSection far_section(const Diagnosis& d, const Pictures& pictures) {
  std::string text;
  if (pictures.how_far.empty()) text = "No test was simulated with an effect added.";
  if (!d.withheld.observations.empty())
    text = fmt::format("Withheld in turn: {}. Fitted and withheld are of the same features.",
                       fmt::join(d.withheld.observations, ", "));
  if (d.fitted.nothing_to_close)
    text += " Of these features together the gap is within the noise: there is nothing to close.";
  return section("How far the gap shrinks", text, pictures.how_far);
}

viz::ReportSection next_section(const Diagnosis& d, const Pictures& pictures) {
  const auto& steps = d.next;
  std::string text;
  if (steps.experiments.empty())
    text = diagnosis::is_settled(d) ? "One explanation is left: nothing more is needed."
           : steps.now.cases == 0   ? "The bank is too small to tell what a further measurement would bring."
                                    : "No further measurement of the list would help.";
  const bool lacks_runs = std::any_of(steps.experiments.begin(), steps.experiments.end(),
                                      [](const auto& next) { return next.runs > 0; });
  if (lacks_runs) text += "Where runs are missing, --plan makes them.";
  auto out = section("What to measure next", text, pictures.next);
  if (!steps.experiments.empty())
    out.tables = {
        to_report(shown_next_table(steps),
                  "Runs of the bank taken for the truth, by the present probabilities, and diagnosed "
                  "with the further measurement as it is usually made.")};
  return out;
}

viz::ReportSection ledger_section(const Diagnosis& d) {
  Table table = ledger_table(d);
  auto out = section("Simulated tests",
                     fmt::format("{} in all, of which {} failed or were not made; these come first.",
                                 d.ledger.size(), not_made(d)),
                     {});
  if (d.ledger.empty()) return out;
  out.tables.push_back(to_report(ledger_counts(d), "Tests by purpose."));
  std::string caption;
  if (table.rows.size() > kLongestLedger) {
    caption = fmt::format("The first {} of {}; ledger.csv has all.", kLongestLedger, table.rows.size());
    table.rows.resize(kLongestLedger);
  }
  for (auto& row : table.rows) row[0] = std::get<std::string>(row[0]).substr(0, 12);
  out.tables.push_back(to_report(table, caption));
  return out;
}

}  // namespace

viz::Report page_of(const Diagnosis& d, const Pictures& pictures) {
  viz::Report report;
  report.title = "Diagnosis: " + d.experiment;
  report.summary = d.verdict;
  report.warnings = d.warnings;
  report.figures = figures_of(d);
  report.sections.push_back(where_section(d, pictures));
  if (!pictures.overlays.empty())
    report.sections.push_back(section("Measured beside simulated", "", pictures.overlays));
  report.sections.push_back(which_section(d, pictures));
  report.sections.push_back(promise_section(d));
  report.sections.push_back(far_section(d, pictures));
  report.sections.push_back(next_section(d, pictures));
  report.sections.push_back(budget_section(d));
  report.sections.push_back(excluded_section(d));
  report.sections.push_back(ledger_section(d));
  report.provenance = to_json(d.provenance);
  return report;
}

}  // namespace pendular::diagnosis_report
