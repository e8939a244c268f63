#include "blind/plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "blind/engine.h"
#include "blind/mechanism.h"
#include "effects/list.h"

namespace pendular::blind {
namespace {

constexpr double kWeakest = 0.2;  // of an effect's range, where the split does not say from where it is seen
constexpr double kHidden = 0.1;   // of the single effects that could be: below what can be seen
constexpr std::size_t kNoEffectEvery = 3;  // so many cases of another engine
constexpr double kFarthestOffset = 2.0;    // of a believed value that is not deliberately wrong, in its sd
constexpr double kWrong = 2.0;             // of one that is

/// Random numbers one after the other.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double between(double low, double high) { return low + (high - low) * random_uniform(seed_, next_++); }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  double normal() { return random_normal(random_bits(seed_, 1), next_++); }
  std::uint64_t bits() { return random_bits(seed_, next_++); }
  template <typename Item>
  void shuffle(std::vector<Item>& items) {
    for (std::size_t k = items.size(); k > 1; --k)
      std::swap(items[k - 1], items[static_cast<std::size_t>(between(0.0, static_cast<double>(k)))]);
  }

 private:
  std::uint64_t seed_, next_ = 0;
};

/// Items in random order, again and again, so that each comes up about as often.
template <typename Item>
class Deck {
 public:
  Deck(std::vector<Item> items, Dice& dice) : items_(std::move(items)), dice_(dice) {}
  Item draw() {
    if (next_ % items_.size() == 0) dice_.shuffle(items_);
    return items_[next_++ % items_.size()];
  }

 private:
  std::vector<Item> items_;
  Dice& dice_;
  std::size_t next_ = 0;
};

/// How many cases each stratum gets: shares rounded so that the sum stays.
std::array<std::size_t, kStrata> counts_of(const Split& split) {
  std::array<std::size_t, kStrata> counts = {};
  std::vector<std::pair<double, std::size_t>> rest;
  std::size_t given = 0;
  for (std::size_t k = 0; k < kStrata; ++k) {
    const double wanted = split.shares[k] * static_cast<double>(split.cases);
    counts[k] = static_cast<std::size_t>(wanted);
    given += counts[k];
    rest.emplace_back(static_cast<double>(counts[k]) - wanted, k);
  }
  std::sort(rest.begin(), rest.end());
  for (std::size_t k = 0; given < split.cases; ++k, ++given) ++counts[rest[k % kStrata].second];
  return counts;
}

/// Whether an effect can show in what is observed.
bool can_show(const effects::Effect& effect, const Sample& sample) {
  return !effect.inert_in || effect.inert_in(sample).empty();
}

double draw_theta(const effects::Effect& effect, Dice& dice) {
  const double size = dice.between(kWeakest, 1.0);
  if (effect.bank_from >= 0.0) return effect.bank_from + size * (effect.bank_to - effect.bank_from);
  return size * (dice.chance(0.5) ? effect.bank_from : effect.bank_to);
}

/// From where the effect is seen to the end of the bank, or, hidden, from zero to there.
double draw_theta(const effects::Effect& effect, double seen_from, bool hidden, Dice& dice) {
  const double end = effect.bank_from < 0.0 && dice.chance(0.5) ? effect.bank_from : effect.bank_to;
  const double seen = std::min(seen_from, std::fabs(end));
  return std::copysign(hidden ? dice.between(0.0, seen) : dice.between(seen, std::fabs(end)), end);
}

/// Draws the truth of cases one after the other, so that effects, mechanisms, wrong beliefs and laws take
/// turns.
class Truths {
 public:
  Truths(const Split& split, Dice& dice)
      : split_(split),
        dice_(dice),
        effects_(effects_of(split), dice),
        mechanisms_(mechanisms_of(), dice),
        beliefs_(beliefs_of(split), dice),
        laws_(other_laws(), dice),
        engines_(split.engines, dice) {}

  CasePlan draw(Stratum stratum, std::size_t number) {
    CasePlan plan;
    plan.stratum = stratum;
    for (const auto& [key, sigma] : split_.uncertainty)
      plan.offsets[key] = std::clamp(dice_.normal(), -kFarthestOffset, kFarthestOffset);
    switch (stratum) {
      case Stratum::none:
        break;
      case Stratum::library:
        add_effects(plan, 1);
        break;
      case Stratum::pair:
        add_effects(plan, 2);
        break;
      case Stratum::outside:
        add_mechanism(plan);
        break;
      case Stratum::wrong_belief:
        if (!split_.uncertainty.empty()) plan.offsets[beliefs_.draw()] = dice_.chance(0.5) ? kWrong : -kWrong;
        add_effects(plan, number % 2);
        break;
      case Stratum::other_law:
        plan.law = laws_.draw();
        add_effects(plan, 1);
        break;
      case Stratum::other_engine:
        plan.engine = engines_.draw();
        add_effects(plan, number % kNoEffectEvery != 0);
        break;
    }
    return plan;
  }

 private:
  static std::vector<const effects::Effect*> effects_of(const Split& split) {
    std::vector<const effects::Effect*> found;
    for (const auto& effect : effects::all_effects())
      if (can_show(effect, split.sample)) found.push_back(&effect);
    return found;
  }
  static std::vector<const Mechanism*> mechanisms_of() {
    std::vector<const Mechanism*> found;
    for (const auto& mechanism : all_mechanisms()) found.push_back(&mechanism);
    return found;
  }
  static std::vector<std::string> beliefs_of(const Split& split) {
    std::vector<std::string> keys;
    for (const auto& [key, sigma] : split.uncertainty) keys.push_back(key);
    return keys;
  }
  static std::vector<std::string> other_laws() {
    std::vector<std::string> names;
    for (const auto& [name, settings] : laws())
      if (!settings.empty()) names.push_back(name);
    return names;
  }

  void add_effects(CasePlan& plan, std::size_t count) {
    while (plan.effects.size() < count) {
      const auto* effect = effects_.draw();
      if (!plan.engine.empty() && !has_effect(find_engine(plan.engine, "split"), effect->id)) continue;
      const auto seen = split_.seen_from.find(effect->id);
      if (seen == split_.seen_from.end()) {
        plan.effects.emplace(effect->id, draw_theta(*effect, dice_));
        continue;
      }
      plan.hidden = count == 1 && dice_.chance(kHidden);
      plan.effects.emplace(effect->id, draw_theta(*effect, seen->second, plan.hidden, dice_));
    }
  }
  void add_mechanism(CasePlan& plan) {
    const auto* mechanism = mechanisms_.draw();
    plan.mechanism = mechanism->id;
    plan.mechanism_theta = dice_.between(mechanism->from, mechanism->to);
  }

  const Split& split_;
  Dice& dice_;
  Deck<const effects::Effect*> effects_;
  Deck<const Mechanism*> mechanisms_;
  Deck<std::string> beliefs_, laws_, engines_;
};

/// What an experimenter measured, by the split's shares; from coordination and lateral strain on, each of the
/// rest by chance.
void draw_observations(CasePlan& plan, const Split& split, Dice& dice) {
  const double level = dice.between(0.0, 1.0);
  double below = 0.0;
  for (std::size_t k = 0; k < kObserved && level >= below; below += split.observed[k++])
    plan.observed = static_cast<Observed>(k);
  if (plan.observed == Observed::curve) return;
  plan.kinds = {"coordination", "lateral_strain"};
  for (const char* kind : {"broken_bonds", "bridge_stiffness", "bridge_diameters", "bridge_gaps"})
    if (dice.chance(0.5)) plan.kinds.push_back(kind);
  const double network = dice.between(0.0, 1.0);
  plan.bridges_at_rest = plan.scanned() && network < 0.5;
  plan.bridges_under_load = plan.scanned() && network < 0.25;
}

}  // namespace

const std::map<std::string, std::vector<SampleSetting>>& laws() {
  static const std::map<std::string, std::vector<SampleSetting>> all = {
      {"paper", {}},
      {"one_spring", {{"contact.tangential_springs", std::string("one")}}},
      {"fine_step",
       {{"contact.time_step_fraction", 0.1}, {"contact.damping_fraction", 0.2}, {"compression.speed", 7e-5}}},
  };
  return all;
}

std::vector<CasePlan> plan_of(const Split& split) {
  Dice dice(split.seed);
  const auto counts = counts_of(split);
  Truths truths(split, dice);
  std::vector<CasePlan> plans;
  for (std::size_t s = 0; s < kStrata; ++s)
    for (std::size_t k = 0; k < counts[s]; ++k) plans.push_back(truths.draw(static_cast<Stratum>(s), k));
  dice.shuffle(plans);
  for (std::size_t k = 0; k < plans.size(); ++k) {
    CasePlan& plan = plans[k];
    plan.name = fmt::format("case_{:03d}", k + 1);
    plan.packing = k % split.packings.size();
    plan.seed = dice.bits() >> 1;  // fits a signed number of JSON and TOML
    const std::uint64_t high = dice.bits(), low = dice.bits();
    plan.salt = fmt::format("{:016x}{:016x}", high, low);
    draw_observations(plan, split, dice);
  }
  return plans;
}

std::string right_answer(const CasePlan& plan) {
  if (!plan.mechanism.empty()) return "unknown";
  std::string answer;
  for (const auto& effect : effects::all_effects())
    if (plan.effects.contains(effect.id)) answer += (answer.empty() ? "" : "+") + effect.id;
  return answer.empty() ? "none" : answer;
}

}  // namespace pendular::blind
