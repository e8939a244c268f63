#include "diagnosis/bank/bank.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "diagnosis/bank/contact_features.h"
#include "diagnosis/bank/law_readings.h"
#include "diagnosis/experiment/believed.h"
#include "diagnosis/experiment/specimens.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr int kGenerated = 6, kMeasured = 12;  // members of an ensemble
constexpr int kDraws = 3;                      // of effects that draw, at each magnitude
constexpr int kFiner = 2;                      // magnitudes of effects that do not draw, over those of others
constexpr int kMembersOfScans = 4;  // without an effect, of tests that end at a scan, over those of others
constexpr int kDrawsOfScans = 2;    // of effects that draw, likewise
constexpr int kOfALaw = 8;          // members that are run with the other reading of a law, at most
constexpr double kMostBeads = 2000.0, kBankBeads = 1500.0;

const SampleKey& key_of(const std::string& name) {
  static const std::vector<SampleKey> keys = sample_keys();
  return *std::find_if(keys.begin(), keys.end(), [&](const SampleKey& key) { return key.name == name; });
}

/// A believed value moved by standard deviations; in the same share where this specimen has another value.
double moved(const Experiment& experiment, const Sample& sample, const std::string& key, double sds) {
  const double sd = floating_inputs(experiment).at(key);
  const double base = sample_key(experiment.sample, key), here = sample_key(sample, key);
  const double value = base != 0.0 ? here * (1.0 + sds * sd / base) : here + sds * sd;
  return std::clamp(value, key_of(key).lowest, key_of(key).highest);
}

/// Magnitudes of an effect in the bank: about what the measured beads themselves show of it, where they do.
std::vector<double> magnitudes_of(const effects::Effect& effect, int levels, const Experiment& experiment,
                                  bool scanned) {
  std::vector<double> found;
  if (const auto shown = experiment.contacts && effect.shown_by_beads
                             ? effect.shown_by_beads(*experiment.contacts)
                             : std::nullopt) {
    for (int k = 1; k <= levels; ++k)
      found.push_back(
          std::clamp(kThresholds.about_shown * k / levels * *shown, effect.lowest, effect.highest));
    return found;
  }
  const bool both = effect.bank_from < 0.0 && effect.bank_to > 0.0;
  const int count = both ? std::max(2, 2 * levels / 3) : std::max(1, levels);
  for (int k = 1; k <= count; ++k) {
    const double share = static_cast<double>(k) / count;
    if (both && (k == count || levels > 2)) found.push_back(share * effect.bank_from);
    found.push_back(share * (effect.bank_to != 0.0 ? effect.bank_to : effect.bank_from));
  }
  if (scanned && !both)
    found.push_back(kThresholds.low_magnitude * (effect.bank_to != 0.0 ? effect.bank_to : effect.bank_from));
  return found;
}

/// Why an effect cannot act in any of these tests; empty where it can.
std::string why_inert(const effects::Effect& effect, const Sample& believed,
                      const std::vector<Condition>& conditions) {
  if (!effect.inert_in) return "";
  for (const auto& condition : conditions)
    if (effect.inert_in(condition.sample).empty()) return "";
  return effect.inert_in(conditions.empty() ? believed : conditions.front().sample);
}

/// A specimen of the same shape with fewer beads.
Condition smaller(Condition condition, double size) {
  condition.sample.specimen.diameter *= size;
  condition.sample.specimen.height *= size;
  return condition;
}

class Planner {
 public:
  Planner(const Experiment& experiment, const BankOptions& options, const fs::path& beads_folder)
      : experiment_(experiment), options_(options), packings_(beads_folder) {
    plan_.conditions = conditions_of(experiment);
    plan_.size = sizes_of(plan_.conditions);
    plan_.further = options.runs;
    for (const auto& condition : plan_.conditions) measured_ = measured_ && !condition.beads.empty();
    scaled_ = plan_.scaled();
  }

  BankPlan plan() {
    members_ = measured_ ? kMeasured : kGenerated;
    const bool scanned = std::any_of(plan_.conditions.begin(), plan_.conditions.end(), ends_at_scan);
    for (int member = 1; member <= (scanned ? kMembersOfScans : 1) * members_; ++member) {
      add({member, "", 0.0, !scaled_, draw_seed(member, 0), member > members_});
      if (scaled_) add({member, "", 0.0, true, draw_seed(member, 0), member > members_});
    }
    for (const auto& effect : effects::all_effects()) {
      if (options_.leave_out.contains(effect.id)) plan_.absent[effect.id] = "left out as asked";
      if (const std::string why = why_inert(effect, experiment_.sample, plan_.conditions); !why.empty())
        plan_.absent.emplace(effect.id, why);
      if (!plan_.absent.contains(effect.id) && !effect.reads_only()) add_effect(effect, scanned);
    }
    int turn = 0;
    for (const auto& [key, sd] : floating_inputs(experiment_)) {
      if (sd <= 0.0) continue;
      // A packing denser than stated may not exist.
      const bool dense = key == "specimen.volume_fraction";
      for (double sds : dense ? std::vector<double>{-2.0, -1.0} : std::vector<double>{-2.0, -1.0, 1.0, 2.0}) {
        const int member = 1 + turn++ % members_;
        add({member, key, sds, !scaled_, draw_seed(member, 0), false, {{key, sds}}});
      }
    }
    for (const auto& reading : law_readings())
      for (int member = 1; member <= std::min(kOfALaw, members_); ++member)
        add({member, reading.id, 1.0, !scaled_, draw_seed(member, 0), false, {{reading.id, 1.0}}});
    return std::move(plan_);
  }

 private:
  void add_effect(const effects::Effect& effect, bool scanned) {
    const int draws = effect.draws ? kDraws : 1;
    int turn = 0;
    const int levels = effect.draws ? options_.levels : kFiner * options_.levels;
    for (double theta : magnitudes_of(effect, levels, experiment_, scanned))
      for (int draw = 0; draw < (effect.draws && scanned ? kDrawsOfScans : 1) * draws; ++draw) {
        const int member = 1 + turn++ % members_;
        add({member,
             effect.id,
             theta,
             !scaled_,
             draw_seed(member, draw),
             draw >= draws,
             {{effect.id, theta}}});
      }
  }

  void add(const DesignPoint& point) { add_points(experiment_, {point}, packings_, plan_); }

  const Experiment& experiment_;
  const BankOptions& options_;
  MemberPackings packings_;
  BankPlan plan_;
  bool measured_ = true, scaled_ = false;
  int members_ = kGenerated;
};

}  // namespace

Sample changed_condition(const Experiment& experiment, const Condition& condition, const Changes& changes,
                         double size) {
  return changed_sample(condition.sample, [&](Sample& sample) {
    for (const auto& [id, value] : changes) {
      if (const LawReading* reading = find_law_reading(id))
        reading->other(sample);
      else if (const effects::Effect* effect = effects::known_effect(id); !effect)
        set_sample_key(sample, id, moved(experiment, condition.sample, id, value));
      else if (value != 0.0)
        sample.effects[id] = effect->of_the_ends ? size * value : value;
    }
  });
}

std::map<std::string, double> floating_inputs(const Experiment& experiment) {
  auto inputs = experiment.uncertainty;
  const std::string modulus = "bridges.youngs_modulus_pa", fraction = "specimen.volume_fraction";
  if (!inputs.contains(modulus))
    inputs[modulus] = kThresholds.modulus_share * sample_key(experiment.sample, modulus);
  const bool generated = std::any_of(experiment.observations.begin(), experiment.observations.end(),
                                     [](const Observation& o) { return o.beads.empty() && o.has("strain"); });
  if (generated && !inputs.contains(fraction)) inputs[fraction] = kThresholds.fraction_sd;
  return inputs;
}

Changes without_readings(Changes changes) {
  std::erase_if(changes, [](const auto& change) {
    const effects::Effect* effect = effects::known_effect(change.first);
    return effect && effect->reads_only();
  });
  return changes;
}

std::uint64_t draw_seed(int member, int draw) {
  return static_cast<std::uint64_t>(member) + 1000 * static_cast<std::uint64_t>(draw);
}

void add_points(const Experiment& experiment, const std::vector<DesignPoint>& points,
                MemberPackings& packings, BankPlan& plan) {
  for (const auto& point : points) {
    for (std::size_t c = 0; c < plan.conditions.size(); ++c) {
      if (point.scans_only && !ends_at_scan(plan.conditions[c])) continue;
      plan.requests.push_back(request_of(experiment, plan.conditions[c], point.member, point.seed,
                                         point.changes, packings, point.whole ? 1.0 : plan.size[c]));
      plan.runs.push_back({plan.points.size(), c});
    }
    plan.points.push_back(point);
  }
}

BankPlan plan_bank(const Experiment& experiment, const BankOptions& options, const fs::path& beads_folder) {
  return Planner(experiment, options, beads_folder).plan();
}

std::vector<double> sizes_of(const std::vector<Condition>& conditions) {
  std::vector<double> sizes;
  for (const auto& condition : conditions) {
    const double beads = beads_in(condition);
    const bool scaled = condition.beads.empty() && beads > kMostBeads;
    sizes.push_back(scaled ? std::cbrt(kBankBeads / beads) : 1.0);
  }
  return sizes;
}

sweep::RunRequest request_of(const Experiment& experiment, const Condition& condition, int member,
                             std::uint64_t seed, const Changes& changes, MemberPackings& packings,
                             double size) {
  const Condition sized = smaller(condition, size);
  sweep::RunRequest request;
  request.sample = changed_condition(experiment, sized, without_readings(changes), size);
  request.packing = packings.of(sized, member, request.sample);
  request.seed = seed;
  return request;
}

}  // namespace pendular::diagnosis
