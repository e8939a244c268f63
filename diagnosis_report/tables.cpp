#include "diagnosis_report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantity.h"
#include "diagnosis/words.h"
#include "diagnosis_report/explanations.h"
#include "effects/list.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Diagnosis;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string yes(bool value) {
  return value ? "yes" : "no";
}

/// Adds to the number of the row that starts with these words, which is made where it is not there.
void add_to(Table& table, const std::vector<Cell>& start, double amount, std::size_t column) {
  for (auto& row : table.rows)
    if (std::equal(start.begin(), start.end(), row.begin())) {
      row[column] = std::get<double>(row[column]) + amount;
      return;
    }
  auto row = start;
  row.resize(table.columns.size(), Cell(0.0));
  row[column] = amount;
  table.rows.push_back(std::move(row));
}

std::vector<Cell> hypothesis_row(const Diagnosis& d, const diagnosis::Explanation& e) {
  std::vector<Cell> row = {e.id, diagnosis::plain_name(e.id), e.probability};
  for (std::size_t k = 0; k < 2; ++k) {
    const bool there = k < e.magnitudes.size();
    row.emplace_back(there ? e.magnitudes[k].mean : kNone);
    row.emplace_back(there ? e.magnitudes[k].interval_90.first : kNone);
    row.emplace_back(there ? e.magnitudes[k].interval_90.second : kNone);
    row.emplace_back(k < e.units.size() ? e.units[k] : "");
  }
  row.emplace_back(e.reduced_chi_squared);
  row.emplace_back(yes(in_ambiguity_set(d, e.id)));
  row.emplace_back(yes(e.excluded));
  row.emplace_back(e.reason);
  return row;
}

bool is_done(const diagnosis::LedgerRow& row) {
  return row.status == "done";
}

constexpr double kOfZ = 0.2;  ///< what is told of z: a decimal

/// A cell of numbers as a share in per cent; empty where there is none.
void tell_share(Cell& cell) {
  const double share = std::get<double>(cell);
  cell = std::isfinite(share) ? percent(share) : "";
}

/// A purpose without its magnitudes: what stands before a colon, or else the first word.
std::string kind_of(const std::string& purpose) {
  const std::size_t colon = purpose.find(": ");
  return purpose.substr(0, colon != std::string::npos ? colon : purpose.find(' '));
}

}  // namespace

Table gap_table(const Diagnosis& d) {
  Table table{"gap",
              {"observation", "feature", "scale", "strain_from", "strain_to", "observed", "simulated",
               "compared_by", "difference", "sigma", "z", "significant", "share"},
              {}};
  for (const auto& row : d.gap.rows) {
    const auto& f = row.observed;
    table.rows.push_back({f.observation, f.name, to_string(f.scale), f.strain_from, f.strain_to, f.value,
                          row.simulated, f.logarithm ? "ratio" : "difference", row.difference, row.sigma,
                          row.z, yes(row.significant), row.share});
  }
  return table;
}

Table shown_gap_table(const Diagnosis& d) {
  Table table{"", {"feature", "observed", "simulated", "difference", "sigma", "z", "share of the gap"}, {}};
  for (const auto& row : d.gap.rows) {
    const auto& f = row.observed;
    const std::string unit = diagnosis::unit_of(f);
    const auto compared = [&](double value) {
      return f.logarithm ? percent(std::expm1(value)) : quantity_within(value, row.sigma, unit);
    };
    table.rows.push_back({diagnosis::in_words(f), quantity(f.value, unit), quantity(row.simulated, unit),
                          compared(row.difference), compared(row.sigma),
                          quantity_within(row.z, kOfZ, "1") + (row.significant ? " *" : ""),
                          percent(row.share)});
  }
  return table;
}

Table share_table(const Diagnosis& d) {
  Table table{"gap_shares", {"by", "name", "share"}, {}};
  for (const auto& row : d.gap.rows) add_to(table, {"scale", to_string(row.observed.scale)}, row.share, 2);
  for (const auto& row : d.gap.rows) add_to(table, {"observation", row.observed.observation}, row.share, 2);
  return table;
}

Table shown_share_table(const Diagnosis& d) {
  Table table = share_table(d);
  for (auto& row : table.rows) row.back() = percent(std::get<double>(row.back()));
  return table;
}

Table noise_table(const Diagnosis& d) {
  Table table{"noise_budget",
              {"observation", "feature", "ensemble", "measurement", "model", "believed", "total"},
              {}};
  for (std::size_t k = 0; k < d.noise.size() && k < d.gap.rows.size(); ++k) {
    const auto& noise = d.noise[k];
    const auto& row = d.gap.rows[k];
    table.rows.push_back({row.observed.observation, row.observed.name, noise.ensemble, noise.measurement,
                          noise.model, noise.believed, row.sigma});
  }
  return table;
}

Table hypothesis_table(const Diagnosis& d) {
  Table table{"hypotheses",
              {"id", "name", "probability", "magnitude", "low_90", "high_90", "unit", "magnitude_2",
               "low_90_2", "high_90_2", "unit_2", "misfit", "in_ambiguity_set", "excluded", "reason"},
              {}};
  for (const auto& explanation : d.explanations) table.rows.push_back(hypothesis_row(d, explanation));
  return table;
}

Table shown_hypothesis_table(const Diagnosis& d) {
  Table table{"", {"explanation", "probability", "magnitude (90 % interval)", "remark"}, {}};
  const Shown shown = shown_of(d);
  for (const auto& e : shown.explanations) {
    std::string remark = in_ambiguity_set(d, e.id) ? "in the ambiguity set" : e.excluded ? "excluded" : "";
    if (!e.excluded && !e.reason.empty()) remark += (remark.empty() ? "" : ": ") + e.reason;
    table.rows.push_back({diagnosis::name_and_id(e.id), percent(e.probability),
                          e.excluded ? "" : diagnosis::magnitudes_in_words(e), remark});
  }
  if (shown.other_pairs > 0)
    table.rows.push_back({std::to_string(shown.other_pairs) + " other pairs together",
                          percent(shown.other_probability), "", ""});
  return table;
}

Table shown_excluded_table(const Diagnosis& d) {
  Table table{"", {"explanation", "probability", "reason"}, {}};
  for (const auto& e : d.explanations)
    if (e.excluded) table.rows.push_back({diagnosis::name_and_id(e.id), percent(e.probability), e.reason});
  return table;
}

Table excluded_table(const Diagnosis& d) {
  Table table{"excluded", {"id", "name", "probability", "reason"}, {}};
  for (const auto& e : d.explanations)
    if (e.excluded) table.rows.push_back({e.id, diagnosis::plain_name(e.id), e.probability, e.reason});
  return table;
}

Table unseen_table(const Diagnosis& d) {
  Table table{"unseen", {"effect", "name", "limit_95", "unit"}, {}};
  for (const auto& one : d.unseen)
    table.rows.push_back({one.effect, diagnosis::plain_name(one.effect), one.limit, one.unit});
  return table;
}

Table shown_unseen_table(const Diagnosis& d) {
  Table table{"unseen", {"effect", "limit_95"}, {}};
  for (const auto& one : d.unseen)
    table.rows.push_back(
        {diagnosis::name_and_id(one.effect), diagnosis::limit_in_words(one.limit, one.unit)});
  return table;
}

Table promise_table(const Diagnosis& d) {
  Table table{"promises",
              {"effect", "name", "replayed_runs", "told_from_none", "named_first", "in_set",
               "told_from_negative", "told_from_positive", "seen_from", "unit"},
              {}};
  for (const auto& [id, effect] : d.promise.effects) {
    const double runs = static_cast<double>(effect.cases);
    const auto [negative, positive] = told_from(d, id);
    const std::string unit = effect.runs.empty() ? "" : effects::find_effect(id, "diagnosis").unit;
    table.rows.push_back({id, diagnosis::plain_name(id), runs,
                          static_cast<double>(effect.told_from_none) / runs,
                          static_cast<double>(effect.first) / runs, static_cast<double>(effect.in_set) / runs,
                          negative, positive, effect.seen_from(), unit});
  }
  return table;
}

Table shown_promise_table(const Diagnosis& d) {
  Table table = promise_table(d);
  table.columns.erase(table.columns.begin() + 1);
  table.columns.pop_back();
  for (auto& row : table.rows) {
    for (const std::size_t column : {3, 4, 5}) tell_share(row[column]);
    for (const std::size_t column : {6, 7, 8}) {
      const double from = std::get<double>(row[column]);
      row[column] = std::isfinite(from) ? diagnosis::limit_in_words(from, std::get<std::string>(row[9])) : "";
    }
    row.erase(row.begin());
    row.pop_back();
  }
  return table;
}

Table reliability_table(const Diagnosis& d) {
  Table table{"reliability", {"probability_said", "share_that_came_true", "replayed_runs"}, {}};
  for (const auto& bin : d.promise.reliability)
    table.rows.push_back({bin.said, bin.came_true, static_cast<double>(bin.cases)});
  return table;
}

Table shown_reliability_table(const Diagnosis& d) {
  Table table = reliability_table(d);
  for (auto& row : table.rows)
    for (const std::size_t column : {0, 1}) tell_share(row[column]);
  return table;
}

Table next_table(const diagnosis::NextSteps& steps) {
  Table table{
      "next_experiments",
      {"observation", "gain_bits", "expected_set_size", "probability_settled", "cost", "runs_missing", "why"},
      {}};
  const auto add = [&](const std::string& name, double gain, const diagnosis::Outlook& outlook, double cost,
                       std::size_t runs, const std::string& why) {
    const bool known = outlook.cases > 0;
    table.rows.push_back({name, known ? gain : kNone, known ? outlook.set_size : kNone,
                          known ? outlook.settled : kNone, cost, static_cast<double>(runs), why});
  };
  if (steps.now.cases > 0) add("nothing more", 0.0, steps.now, 0.0, 0, "as the experiment is");
  for (const auto& next : steps.experiments)
    add(next.observation, next.gain, next.outlook, next.cost, next.runs, next.why);
  return table;
}

Table shown_next_table(const diagnosis::NextSteps& steps) {
  Table table = next_table(steps);
  for (auto& row : table.rows) tell_share(row[3]);
  return table;
}

Table next_effects_table(const diagnosis::NextSteps& steps) {
  Table table{
      "next_effects", {"observation", "effect", "replayed_runs", "told_from_none", "named_first"}, {}};
  const auto add = [&](const std::string& name, const diagnosis::Outlook& outlook) {
    for (const auto& [id, effect] : outlook.effects) {
      const double runs = static_cast<double>(effect.cases);
      table.rows.push_back({name, id, runs, static_cast<double>(effect.told_from_none) / runs,
                            static_cast<double>(effect.first) / runs});
    }
  };
  add("nothing more", steps.now);
  for (const auto& next : steps.experiments) add(next.observation, next.outlook);
  return table;
}

Table ledger_table(const Diagnosis& d) {
  auto ledger = d.ledger;
  std::stable_partition(ledger.begin(), ledger.end(), [](const auto& row) { return !is_done(row); });
  Table table{"ledger", {"run", "purpose", "condition", "status", "message"}, {}};
  for (const auto& row : ledger)
    table.rows.push_back(
        {row.hash, row.purpose, static_cast<double>(row.condition), row.status, row.message});
  return table;
}

Table ledger_counts(const Diagnosis& d) {
  Table table{"", {"purpose", "runs", "not made"}, {}};
  for (const auto& row : d.ledger) {
    add_to(table, {kind_of(row.purpose)}, 1.0, 1);
    add_to(table, {kind_of(row.purpose)}, is_done(row) ? 0.0 : 1.0, 2);
  }
  return table;
}

}  // namespace pendular::diagnosis_report
