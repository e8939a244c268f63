#pragma once

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "base/files.h"
#include "base/random.h"
#include "diagnosis/bank/runner.h"

namespace pendular::diagnosis::test {

/// What is believed of the toy.
inline constexpr const char* kToySample = R"([beads]
diameter_um = 200
density_kg_m3 = 2500
[bridges]
youngs_modulus_pa = 1.5e6
poisson_ratio = 0.49
diameter_um = 74
gap_um = 2
[contact]
friction = 0.5
[specimen]
diameter_um = 1500
height_um = 1500
volume_fraction = 0.58
)";

inline constexpr double kToyModulus = 1.5e6;  // that it believes

/// A specimen in closed form in the place of the simulation: a toe, a line of slope E ∝ E_p, a peak. Missing
/// bridges soften it and show in Z; friction of beads raises what comes after the line; toy_softness, which a
/// test may add, lowers E alone; nothing else acts.
class ToyRuns {
 public:
  explicit ToyRuns(const fs::path& folder) : folder_(folder) {}

  /// Effects whose runs fail.
  std::set<std::string> failing;
  /// Further factor of the modulus, which no effect makes.
  double unexplained = 1.0;
  double lateral_ratio = 0.1;
  /// By how much missing bridges add to what the polymer's modulus does: beyond the product of both.
  double interplay = 0.0;

  std::vector<sweep::RunOutcome> operator()(const std::string&, std::span<const sweep::RunRequest> requests) {
    std::vector<sweep::RunOutcome> outcomes;
    for (const auto& request : requests) outcomes.push_back(make(request));
    return outcomes;
  }

  /// Stress and broken-off share of one curve: what an experimenter would write down.
  std::string curve_text(const Sample& sample, std::uint64_t seed) const {
    std::string text = "strain,stress_pa,broken_bonds,lateral_strain\n";
    const double missing = of(sample, "missing_bridges"), friction = of(sample, "bead_friction");
    const double beyond_product =
        1.0 + interplay * missing * (sample.bridges.youngs_modulus / kToyModulus - 1.0);
    const double modulus = 10.0 * sample.bridges.youngs_modulus * (1.0 - 2.0 * missing) * beyond_product *
                           (1.0 - of(sample, "toy_softness")) * unexplained *
                           (1.0 + 0.005 * random_normal(seed, 1));
    for (int k = 0; k <= kRows; ++k) {
      const double strain = kStrain * k / kRows, beyond = strain - 0.01;
      const double line = modulus * 0.5 * (beyond + std::hypot(beyond, 0.004));
      const double fall = std::pow(strain / (0.08 * (1.0 + 0.2 * friction)), 8.0);
      const double noise = 1.0 + 0.002 * random_normal(seed, 10 + static_cast<std::uint64_t>(k));
      text += fmt::format("{},{},0,{}\n", strain, line * std::exp(-fall) * noise, lateral_ratio * strain);
    }
    return text;
  }

  static double coordination(const Sample& sample) { return 7.4 * (1.0 - of(sample, "missing_bridges")); }

 private:
  static constexpr int kRows = 250;
  static constexpr double kStrain = 0.1;

  static double of(const Sample& sample, const std::string& effect) {
    const auto found = sample.effects.find(effect);
    return found == sample.effects.end() ? 0.0 : found->second;
  }

  sweep::RunOutcome make(const sweep::RunRequest& request) {
    sweep::RunOutcome outcome;
    outcome.hash = fmt::format("toy{}", ++made_);
    for (const auto& id : failing)
      if (request.sample.effects.contains(id)) {
        outcome.status = sweep::RunStatus::failed;
        outcome.message = "it fell apart";
        return outcome;
      }
    outcome.status = sweep::RunStatus::done;
    outcome.folder = folder_ / outcome.hash;
    make_folder(outcome.folder);
    write_text(outcome.folder / "curve.csv", curve_text(request.sample, request.seed));
    write_text(outcome.folder / "result.json",
               fmt::format("{{\"specimen\": {{\"section_mm2\": 2.0, \"height_um\": 2000}}, "
                           "\"coordination\": {{\"bridges_per_interior_bead\": {}}}}}",
                           coordination(request.sample)));
    return outcome;
  }

  fs::path folder_;
  int made_ = 0;
};

}  // namespace pendular::diagnosis::test
