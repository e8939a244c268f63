#include "diagnosis/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pendular::diagnosis {
namespace {

std::string joined(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "" : k + 1 == words.size() ? last : ", ") + words[k];
  return text;
}

std::string feature_of(const GapRow& row) {
  const auto& feature = row.observed;
  return feature.name == feature.observation ? feature.name
                                             : fmt::format("{} of {}", feature.name, feature.observation);
}

/// "1.9 times too stiff" for a modulus, else in the feature's own words.
std::string in_words(const GapRow& row) {
  const auto& feature = row.observed;
  if (!feature.logarithm)
    return fmt::format("{} is {:.3g} in the simulation and {:.3g} in the experiment", feature_of(row),
                       row.simulated, feature.value);
  const double ratio = std::exp(std::fabs(row.difference));
  const bool larger = row.difference > 0.0;
  if (feature.name.find("modulus") != std::string::npos)
    return fmt::format("the simulation is {:.2f} times too {} in {}", ratio, larger ? "stiff" : "soft",
                       feature_of(row));
  return fmt::format("{} is {:.2f} times too {} in the simulation", feature_of(row), ratio,
                     larger ? "large" : "small");
}

std::string where(const Diagnosis& diagnosis) {
  const auto& rows = diagnosis.gap.rows;
  const auto count =
      std::count_if(rows.begin(), rows.end(), [](const GapRow& row) { return row.significant; });
  if (count == 0)
    return fmt::format(
        "No feature of {} differs between experiment and simulation by more than the noise (all |z| below "
        "{:.1f}; the noise of a feature is {:.0f} % at the median).",
        rows.size(), diagnosis.gap.threshold, 100.0 * diagnosis.gap.noise_floor);
  const auto worst = std::max_element(rows.begin(), rows.end(), [](const GapRow& a, const GapRow& b) {
    return std::fabs(a.z) < std::fabs(b.z);
  });
  std::map<std::string, double> shares;
  for (const auto& row : rows) shares[row.observed.observation] += row.share;
  const auto most = std::max_element(shares.begin(), shares.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  std::string text = in_words(*worst);
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  text += fmt::format(" ({:.1f} sigma; noise floor {:.0f} %). {} of {} features differ significantly",
                      std::fabs(worst->z), 100.0 * diagnosis.gap.noise_floor, count, rows.size());
  return text + fmt::format("; {:.0f} % of the gap is in {}.", 100.0 * most->second, most->first);
}

std::string magnitude_of(const Explanation& e) {
  std::string text;
  for (std::size_t k = 0; k < e.magnitudes.size(); ++k) {
    const auto& m = e.magnitudes[k];
    text += fmt::format("{}{:.3g} {} ({:.3g} to {:.3g})", k > 0 ? " and " : "", m.mean, e.units[k],
                        m.interval_90.first, m.interval_90.second);
  }
  return text;
}

std::string which(const Diagnosis& diagnosis) {
  const Explanation& best = diagnosis.explanations.front();
  const auto& set = diagnosis.ambiguity_set;
  if (best.id == "none")
    return fmt::format("Nothing needs to be explained (probability {:.2f}).", best.probability);
  if (best.id == "unknown")
    return fmt::format(
        "No effect of the library explains it (probability {:.2f} for something else); what is missing in "
        "the "
        "simulation is of another kind, or a believed input is farther off than stated.",
        best.probability);
  if (set.size() == 2 && set.back() == "unknown")
    return fmt::format(
        "It is explained by {} at {}, probability {:.2f}; something that is not in the library and acts "
        "alike "
        "cannot be ruled out.",
        best.id, magnitude_of(best), best.probability);
  if (set.size() > 1)
    return fmt::format(
        "{}, {:.2f} together, cannot be told apart here; the most probable, {} at {}, has {:.2f}.",
        joined(set, " and "), diagnosis.set_probability, best.id, magnitude_of(best), best.probability);
  return fmt::format("It is explained by {} at {}, probability {:.2f}.", best.id, magnitude_of(best),
                     best.probability);
}

std::string promise(const Diagnosis& diagnosis) {
  const auto& p = diagnosis.promise;
  if (p.cases == 0) return "";
  std::string text =
      fmt::format(" Of {} replayed runs the set held the truth in {:.0f} % at a mean size of {:.1f}.",
                  p.cases, 100.0 * p.in_set, p.set_size);
  std::vector<std::string> hidden;
  for (const auto& one : diagnosis.unseen)
    hidden.push_back(fmt::format("{} up to {:.2g} {}", one.effect, one.limit, one.unit));
  if (!hidden.empty())
    text += fmt::format(" These observations would hardly show {}.", joined(hidden, " and "));
  return text;
}

std::string how_far(const Diagnosis& diagnosis) {
  if (diagnosis.explanations.front().magnitudes.empty() || diagnosis.fitted.before <= 0.0) return "";
  const auto& withheld = diagnosis.withheld;
  std::string text = fmt::format(" Added to the simulation it closes {:.0f} % of the gap",
                                 100.0 * diagnosis.fitted.fraction);
  if (withheld.observations.empty())
    return text + "; with one observation nothing could be withheld to check that.";
  text += fmt::format(
      " on the data it was fitted to and {:.0f} % ({:.0f} to {:.0f} %) on withheld data; retuning the "
      "polymer's "
      "modulus closes {:.0f} %",
      100.0 * withheld.fraction, 100.0 * withheld.interval_90.first, 100.0 * withheld.interval_90.second,
      100.0 * diagnosis.retuned);
  if (!diagnosis.wrong_effect.empty())
    text += fmt::format(", a wrong effect ({}) {:.0f} %", diagnosis.wrong_effect, 100.0 * diagnosis.wrong);
  return text + ".";
}

std::string what_next(const Diagnosis& diagnosis) {
  const auto& next = diagnosis.next;
  if (next.experiments.empty() || next.experiments.front().outlook.cases == 0) return "";
  const auto& first = next.experiments.front();
  return fmt::format(" Next: {} ({}); expected to leave {:.1f} explanations of {:.1f}.", first.observation,
                     first.why, first.outlook.set_size, next.now.set_size);
}

}  // namespace

std::string verdict_of(const Diagnosis& diagnosis) {
  std::string text = where(diagnosis) + " " + which(diagnosis) + promise(diagnosis) + how_far(diagnosis) +
                     what_next(diagnosis);
  for (const auto& place : diagnosis.places) text += " " + place.words;
  const auto failed = std::count_if(diagnosis.ledger.begin(), diagnosis.ledger.end(),
                                    [](const LedgerRow& row) { return row.status == "failed"; });
  if (failed > 0) text += fmt::format(" {} of {} simulations failed.", failed, diagnosis.ledger.size());
  if (!diagnosis.warnings.empty()) text += fmt::format(" Mind {} warning(s).", diagnosis.warnings.size());
  return text;
}

}  // namespace pendular::diagnosis
