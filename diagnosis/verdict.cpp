#include "diagnosis/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/quantity.h"
#include "diagnosis/advice/next_experiments.h"
#include "diagnosis/repair/shrinkage.h"
#include "diagnosis/thresholds.h"
#include "diagnosis/words.h"

namespace pendular::diagnosis {
namespace {

constexpr std::size_t kListed = 3;       // names in a row; the report has all
constexpr double kWorthASentence = 0.1;  // probability of a pair beside `unknown`; less is listed alone

/// The members of the set beside the most probable one, and but for one more.
std::vector<std::string> others(const Diagnosis& diagnosis, const std::string& but = "") {
  std::vector<std::string> names;
  for (const auto& id : diagnosis.ambiguity_set)
    if (id != diagnosis.explanations.front().id && id != but) names.push_back(name_and_id(id));
  return names;
}

std::ptrdiff_t count_of_significant(const Diagnosis& diagnosis) {
  const auto& rows = diagnosis.gap.rows;
  return std::count_if(rows.begin(), rows.end(), [](const GapRow& row) { return row.significant; });
}

std::string cause(const Diagnosis& diagnosis) {
  const Explanation& best = diagnosis.explanations.front();
  const auto rest = others(diagnosis);
  const std::string probability = percent(best.probability);
  if (best.id == "none") {
    if (rest.empty())
      return fmt::format("Experiment and simulation agree: no effect is needed{}, probability {}.",
                         diagnosis.unseen.empty() ? "" : " that these observations would show", probability);
    return fmt::format("No effect is needed, probability {}; not excluded: {}.", probability,
                       joined(rest, kListed));
  }
  const Explanation* named = to_add(diagnosis);
  if (best.id == kUnknown && named && named->magnitudes.size() == 2 &&
      named->probability >= kWorthASentence) {
    const auto besides = others(diagnosis, named->id);
    return fmt::format(
        "The cause is not known: {} would explain the gap, probability {}, but where one effect leaves as "
        "much the cause is more often outside the library, {}{}.",
        in_words(*named), percent(named->probability), probability,
        besides.empty() ? "" : "; not excluded: " + joined(besides, kListed));
  }
  if (best.id == kUnknown)
    return fmt::format(
        "The cause is not known: {}, probability {}{}.",
        !diagnosis.unlike.empty() ? diagnosis.unlike + ", which no effect of the library brings about"
        : count_of_significant(diagnosis) > 0
            ? "no effect of the library explains the gap"
            : "no feature by itself differs by more than the noise, but together they differ as hardly any "
              "simulated experiment does; something outside the library",
        probability, rest.empty() ? "" : "; not excluded: " + joined(rest, kListed));
  if (best.id == kOtherPairs)
    return fmt::format(
        "The cause is not known: two effects at once, or something like two, explain the gap best, "
        "probability {}, but no run has both (--runs){}.",
        probability, rest.empty() ? "" : "; not excluded: " + joined(rest, kListed));
  const bool likely = best.probability >= kThresholds.likely;
  if (rest.empty())
    return likely ? fmt::format("The cause is {}, probability {}.", in_words(best), probability)
                  : fmt::format("The most probable cause is {}, but with a probability of {} alone.",
                                in_words(best), probability);
  if (likely)
    return fmt::format("The most probable cause is {}, probability {}; not excluded: {}.", in_words(best),
                       probability, joined(rest, kListed));
  return fmt::format(
      "The cause is not known: {} explanations, {} together, cannot be told apart; the most probable is {}, "
      "{}; not excluded: {}.",
      rest.size() + 1, percent(diagnosis.set_probability), in_words(best), probability,
      joined(rest, kListed));
}

/// Beside the cause: what of the law the sample states otherwise.
std::string which_law(const Diagnosis& diagnosis) {
  if (diagnosis.law.empty()) return "";
  std::vector<std::string> settings;
  for (const auto& one : diagnosis.law)
    settings.push_back(
        fmt::format("{} (to {:.2f} ± {:.2f} of what it changes)", one.setting, one.share, one.error));
  return fmt::format(" The experiment follows another reading of the law than the sample states: {}.",
                     joined(settings, kListed));
}

std::string whose_strains(const Diagnosis& diagnosis) {
  if (diagnosis.specimen_strains.empty()) return "";
  return fmt::format(" Strains of {} are taken as the specimen's own, not the machine's.",
                     joined(diagnosis.specimen_strains, kListed));
}

/// One sentence: what, why, and what is expected of it.
std::string what_next(const Diagnosis& diagnosis) {
  const auto& next = diagnosis.next;
  if (!next.experiments.empty() && next.experiments.front().outlook.cases > 0) {
    const auto& first = next.experiments.front();
    return fmt::format(" Next: {} – {}; it is expected to {}.", first.observation, first.why,
                       outlook_in_words(first.outlook, next.now));
  }
  const std::string& best = diagnosis.explanations.front().id;
  if (is_settled(diagnosis) && best != "unknown" && best != kOtherPairs)
    return " No further measurement is needed.";
  return next.now.cases == 0 || !next.experiments.empty()
             ? " What to measure next cannot be told from these runs."
             : " No measurement that is known here would tell more.";
}

/// "the simulation is 1.9 times too stiff in the …" for a modulus, else in the feature's own words.
std::string difference_of(const GapRow& row) {
  const Feature& feature = row.observed;
  if (!feature.logarithm)
    return fmt::format("{} is {} in the simulation and {} in the experiment", in_words(feature),
                       quantity_within(row.simulated, row.sigma, unit_of(feature)),
                       quantity_within(feature.value, row.sigma, unit_of(feature)));
  const std::string ratio = rounded(std::exp(std::fabs(row.difference)));
  const bool larger = row.difference > 0.0;
  if (feature.name.find("modulus") != std::string::npos)
    return fmt::format("the simulation is {} times too {} in the {}", ratio, larger ? "stiff" : "soft",
                       in_words(feature));
  return fmt::format("{} is {} times too {} in the simulation", in_words(feature), ratio,
                     larger ? "large" : "small");
}

std::string where(const Diagnosis& diagnosis) {
  const auto& rows = diagnosis.gap.rows;
  const std::ptrdiff_t count = count_of_significant(diagnosis);
  if (count == 0)
    return fmt::format(
        "None of {} features by itself differs by more than the noise (all |z| below {:.1f}){}.", rows.size(),
        diagnosis.gap.threshold,
        effects_in(diagnosis.explanations.front().id).empty()
            ? ""
            : "; what tells the cause are all readings together");
  const auto worst = std::max_element(rows.begin(), rows.end(), [](const GapRow& a, const GapRow& b) {
    return std::fabs(a.z) < std::fabs(b.z);
  });
  std::map<std::string, double> shares;
  for (const auto& row : rows) shares[row.observed.observation] += row.share;
  const auto most = std::max_element(shares.begin(), shares.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  std::string text = fmt::format("{} of {} features differ; the farthest: {} ({:.1f} sigma).", count,
                                 rows.size(), difference_of(*worst), std::fabs(worst->z));
  if (shares.size() > 1) text += fmt::format(" {} of the gap is in {}.", percent(most->second), most->first);
  return text;
}

std::string how_far(const Diagnosis& diagnosis) {
  const Shrinkage &fitted = diagnosis.fitted, &withheld = diagnosis.withheld;
  const Explanation* added = to_add(diagnosis);
  if (!added || fitted.observations.empty()) return "";
  if (fitted.nothing_to_close)
    return " The gap of these features together is within the noise: nothing to close.";
  const bool cause = added == &diagnosis.explanations.front();
  std::string text =
      fmt::format(" Added to the simulation, {} closes ", cause ? "the cause" : name_and_id(added->id));
  if (withheld.observations.empty())
    return text + in_words(fitted) +
           " of the gap that it was fitted to; one observation leaves nothing to withhold.";
  text += fmt::format(
      "{} of the gap withheld and {} of the gap fitted; a retuned modulus of the polymer closes {}",
      in_words(withheld), in_words(fitted), percent(diagnosis.retuned));
  if (!diagnosis.wrong_effect.empty())
    text +=
        fmt::format(", a wrong effect ({}) {}", plain_name(diagnosis.wrong_effect), percent(diagnosis.wrong));
  return text + ".";
}

std::string trust(const Diagnosis& diagnosis) {
  std::string text;
  const auto& p = diagnosis.promise;
  if (p.cases > 0)
    text += fmt::format("In {} replayed runs the set held the truth in {}, with {:.1f} members on average.",
                        p.cases, percent(p.in_set), p.set_size);
  if (p.outside.cases > 0)
    text += fmt::format(" Of {} runs whose effect was left out of the library {} were flagged as unknown.",
                        p.outside.cases, p.outside.flagged);
  std::vector<std::string> hidden;
  for (const auto& one : diagnosis.unseen)
    hidden.push_back(fmt::format("{} up to {}", plain_name(one.effect), limit_in_words(one.limit, one.unit)));
  if (!hidden.empty())
    text += fmt::format(" These observations would hardly show {}.", joined(hidden, kListed));
  for (const auto& place : diagnosis.places) text += " " + place.words;
  const auto failed = std::count_if(diagnosis.ledger.begin(), diagnosis.ledger.end(),
                                    [](const LedgerRow& row) { return row.status == "failed"; });
  if (failed > 0) text += fmt::format(" {} of {} simulations failed.", failed, diagnosis.ledger.size());
  return text.starts_with(' ') ? text.substr(1) : text;
}

}  // namespace

std::string cause_of(const Diagnosis& diagnosis) {
  return cause(diagnosis) + which_law(diagnosis) + whose_strains(diagnosis);
}

std::string verdict_of(const Diagnosis& diagnosis) {
  std::string text =
      cause_of(diagnosis) + what_next(diagnosis) + "\n" + where(diagnosis) + how_far(diagnosis);
  if (const std::string last = trust(diagnosis); !last.empty()) text += "\n" + last;
  return text;
}

}  // namespace pendular::diagnosis
