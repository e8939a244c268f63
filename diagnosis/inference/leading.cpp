#include "diagnosis/inference/leading.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr int kMembers = 4;                              // that each is run on
constexpr std::size_t kMostPairs = 4, kMostSingles = 2;  // at a time
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

DesignPoint point_of(const Changes& changes, int member, bool whole) {
  DesignPoint point{
      member, changes.begin()->first, changes.begin()->second, whole, draw_seed(member, 0), false, changes};
  if (changes.size() == 2) point.id += "+" + changes.rbegin()->first, point.theta = 1.0;
  return point;
}

}  // namespace

std::vector<DesignPoint> leading_points(const Problem& problem, const Priors& priors, const BankPlan& plan) {
  if (plan.further <= 0) return {};
  const Comparison& readings = problem.readings;
  Priors known = priors;  // before pairs were run what they do looks unknown
  known.unknown = 0.0;
  std::vector<DesignPoint> points;
  std::size_t pairs = 0, singles = 0, runs = 0;
  for (const auto& h : weigh(readings.gap, readings.signatures, readings.together, known)) {
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

}  // namespace pendular::diagnosis
