#include "diagnosis/inference/leading.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/bank/law_readings.h"
#include "diagnosis/inference/reduced_space.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr int kMembers = 4, kMembersOfDraws = 8;         // that each is run on
constexpr std::size_t kMostPairs = 4, kMostSingles = 2;  // at a time
constexpr std::size_t kMostFits = 6;                     // likewise
constexpr double kPullStep = 0.1;                        // standard deviations of what is believed
constexpr double kPairSteps = 3.0, kSteps = 12.0;        // of a bank's range, to which magnitudes are rounded

/// The nearest step of an effect's range in the bank, at least the first.
double rounded(const effects::Effect& effect, double theta, double steps) {
  const double end = theta < 0.0 ? effect.bank_from : effect.bank_to;
  const double largest = end != 0.0 ? end : std::max(std::fabs(effect.bank_from), std::fabs(effect.bank_to));
  return largest * std::clamp(std::round(steps * theta / largest), 1.0, steps) / steps;
}

bool was_run(const BankPlan& plan, const Changes& changes) {
  return std::any_of(plan.points.begin(), plan.points.end(), [&](const DesignPoint& point) {
    if (point.changes.size() != changes.size()) return false;
    return std::all_of(changes.begin(), changes.end(), [&](const auto& change) {
      const auto found = point.changes.find(change.first);
      // A pair was run where its effects were; a single effect where it was, at this magnitude.
      return found != point.changes.end() && (changes.size() > 1 || std::fabs(found->second - change.second) <
                                                                        1e-9 * std::fabs(change.second));
    });
  });
}

/// Whether an effect of an explanation differs from draw to draw.
bool draws(const std::string& id) {
  const auto ids = effects_in(id);
  return std::any_of(ids.begin(), ids.end(),
                     [](const std::string& one) { return effects::find_effect(one, "diagnosis").draws; });
}

/// How many members have tests that go all the way.
int members_of(const BankPlan& plan) {
  int found = 0;
  for (const auto& point : plan.points)
    if (point.id.empty() && !point.scans_only) found = std::max(found, point.member);
  return found;
}

/// Whether an explanation was run as it fits.
bool run_at_fit(const BankPlan& plan, const std::string& id) {
  return std::any_of(plan.points.begin(), plan.points.end(),
                     [&](const DesignPoint& point) { return point.at_fit && point.id == id; });
}

/// How far a bank changes a believed input, to either side.
std::pair<double, double> range_of(const std::string& key, const BankPlan& plan) {
  std::pair<double, double> range{0.0, 0.0};
  for (const auto& point : plan.points)
    if (point.id == key) range = {std::min(range.first, point.theta), std::max(range.second, point.theta)};
  return range;
}

/// What is changed where an explanation fits best: its effects, what is believed as it has it, as far as the
/// bank goes, and the law's other reading where that is nearer.
Changes fit_of(const Comparison& readings, const BankPlan& plan, const Hypothesis& h) {
  Changes changes;
  Magnitudes magnitudes;
  const auto ids = effects_in(h.id);
  for (std::size_t k = 0; k < ids.size(); ++k)
    magnitudes[ids[k]] = h.magnitudes[k], changes[ids[k]] = h.magnitudes[k].mean;
  const Eigen::VectorXd pulls = pulls_of(readings.gap, left_by(readings, magnitudes));
  for (std::size_t c = 0; c < readings.inputs.size(); ++c) {
    const double pull = pulls[static_cast<Eigen::Index>(c)];
    if (const LawReading* law = law_reading_named(readings.inputs[c])) {
      if (share_of_law(plan, *law) * pull > kThresholds.least_followed) changes[law->id] = 1.0;
      continue;
    }
    const auto [lowest, highest] = range_of(readings.inputs[c], plan);
    const double rounded_pull = std::round(pull / kPullStep) * kPullStep;
    if (const double sds = std::clamp(rounded_pull, lowest, highest); sds != 0.0)
      changes[readings.inputs[c]] = sds;
  }
  return changes;
}

/// Whether the most probable explanation needs no second look: none or one effect, beside which neither
/// another nor a pair is probable, and which leaves no more than the noise.
bool is_alone(const Comparison& readings, const Hypothesis& best) {
  const ReducedSpace space(readings.gap, readings.signatures);
  return best.magnitudes.size() < 2 && best.probability > kThresholds.alone &&
         best.chi_squared < static_cast<double>(space.size());
}

DesignPoint point_of(const Changes& changes, int member, bool whole) {
  DesignPoint point{
      member, changes.begin()->first, changes.begin()->second, whole, draw_seed(member, 0), false, changes};
  if (changes.size() == 2) point.id += "+" + changes.rbegin()->first, point.theta = 1.0;
  return point;
}

}  // namespace

std::vector<Hypothesis> known_explanations(const Comparison& readings, Priors priors) {
  priors.unknown = 0.0;
  return weigh(readings.gap, readings.signatures, readings.together, priors);
}

std::vector<DesignPoint> leading_points(const std::vector<Hypothesis>& known, const BankPlan& plan) {
  if (plan.further <= 0) return {};
  std::vector<DesignPoint> points;
  std::size_t pairs = 0, singles = 0, runs = 0;
  for (const auto& h : known) {
    const bool pair = h.magnitudes.size() == 2;
    if (h.magnitudes.empty() || h.probability < (pair ? kThresholds.pair_leads : kThresholds.leads)) continue;
    if (pair ? pairs == kMostPairs : singles == kMostSingles) continue;
    Changes changes;
    std::string rest = h.id;
    for (const auto& magnitude : h.magnitudes) {
      const auto plus = rest.find('+');
      const auto& effect = effects::find_effect(rest.substr(0, plus), "diagnosis");
      rest = plus == std::string::npos ? "" : rest.substr(plus + 1);
      changes[effect.id] = rounded(effect, magnitude.mean, pair ? kPairSteps : kSteps);
    }
    if (was_run(plan, changes)) continue;
    const std::size_t cost = kMembers * plan.conditions.size();
    if (runs + cost > static_cast<std::size_t>(std::max(0, plan.further))) break;
    runs += cost;
    ++(pair ? pairs : singles);
    for (int member = 1; member <= kMembers; ++member)
      points.push_back(point_of(changes, member, !plan.scaled()));
  }
  return points;
}

std::vector<DesignPoint> fitted_points(const Comparison& readings, std::vector<Hypothesis> known,
                                       const BankPlan& plan) {
  if (is_alone(readings, known.front())) return {};
  std::erase_if(
      known, [](const Hypothesis& h) { return h.id == "unknown" || (h.magnitudes.size() == 2 && !h.run); });
  double total = 0.0;
  for (const auto& h : known) total += h.probability;
  std::set<std::string> parts;  // of leading pairs, which are judged against them
  for (const auto& h : known)
    if (h.magnitudes.size() == 2 && h.probability > kThresholds.leads * total)
      for (const auto& id : effects_in(h.id)) parts.insert(id);
  std::vector<DesignPoint> points;
  int left = plan.further;
  std::size_t fits = 0;
  for (const auto& h : known) {
    const bool leads = h.probability > kThresholds.fit_leads * total || parts.contains(h.id);
    if (!leads || run_at_fit(plan, h.id)) continue;
    const int members = std::min(draws(h.id) ? kMembersOfDraws : kMembers, members_of(plan));
    left -= members * static_cast<int>(plan.conditions.size());
    if (left < 0 || ++fits > kMostFits) break;
    const Changes changes = fit_of(readings, plan, h);
    for (int member = 1; member <= members; ++member)
      points.push_back({member, h.id, 1.0, !plan.scaled(), draw_seed(member, 0), false, changes, true});
  }
  return points;
}

}  // namespace pendular::diagnosis
