#include "blind/alike.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/inference/comparison.h"
#include "diagnosis/inference/evidence.h"
#include "effects/list.h"

namespace pendular::blind {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Of an effect at its usual magnitude from the nearest that another can do, or from none.
double usual_distance(const Diagnosed& said, const std::string& effect, const std::string& other) {
  if (effect == other) return 0.0;
  const auto row = said.squared_distance.find(effect);
  if (row == said.squared_distance.end()) return kFar;
  const auto found = row->second.find(other);
  return found == row->second.end() ? kFar : std::sqrt(std::max(0.0, found->second));
}

}  // namespace

double distance_from_truth(const Verdict& verdict, const std::string& answer) {
  if (answer == verdict.answer) return 0.0;
  if (!verdict.said || answer == "unknown" || verdict.answer == "unknown") return kFar;
  const auto& truth = verdict.truth.effects;
  const auto said = diagnosis::effects_in(answer);
  if (truth.empty()) return said.size() == 1 ? usual_distance(*verdict.said, answer, "none") : kFar;
  if (said.size() > truth.size()) return kFar;
  const auto from = [&](std::size_t k, const std::string& other) {
    const auto& [id, theta] = truth[k];
    const double usual = diagnosis::usual_magnitude(effects::find_effect(id, verdict.truth.name));
    return usual_distance(*verdict.said, id, other) * std::fabs(theta) / usual;
  };
  if (said.size() == 2)
    return std::min(from(0, said[0]) + from(1, said[1]), from(0, said[1]) + from(1, said[0]));
  double sum = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) sum += from(k, answer);
  return sum;
}

bool is_right(const Verdict& verdict, const std::string& answer, Counting counting) {
  if (answer == verdict.answer) return true;
  if (counting == Counting::by_name || !verdict.said) return false;
  const auto& effects = verdict.truth.effects;
  if (answer == "none" && effects.size() == 1 && verdict.answer == effects.front().first &&
      verdict.untold(verdict.answer, effects.front().second))
    return true;
  if (const auto claim = verdict.said->claims.find(answer);
      verdict.answer == "none" && claim != verdict.said->claims.end() && claim->second.magnitude &&
      verdict.untold(answer, *claim->second.magnitude))
    return true;
  return distance_from_truth(verdict, answer) < kTold;
}

std::vector<std::string> class_of(const Verdict& verdict) {
  std::vector<std::string> found;
  if (!verdict.said) return found;
  for (const auto& [id, claim] : verdict.said->claims)
    if (id != verdict.answer && diagnosis::effects_in(id).size() < 2 &&
        is_right(verdict, id, Counting::by_class))
      found.push_back(id);
  return found;
}

}  // namespace pendular::blind
