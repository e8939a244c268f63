#include "diagnosis/inference/replay.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "diagnosis/bank/mean_row.h"
#include "diagnosis/inference/weigher.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kNegligible = 12.0;  // evidence, as a logarithm, below the best one's
constexpr int kMoreBaselines = 3;     // draws, over those of other runs
constexpr std::uint64_t kSeedsOfMember = 1000000;

bool is_effect(const std::string& id) {
  const auto& all = effects::all_effects();
  return std::any_of(all.begin(), all.end(), [&](const auto& effect) { return effect.id == id; });
}

/// Errors that a comparison expects of an observation, drawn.
class Errors {
 public:
  explicit Errors(const Comparison& comparison)
      : comparison_(comparison),
        root_(root_of(comparison.observed.measurement + comparison.observed.model)) {}

  Eigen::VectorXd draw(std::uint64_t seed) const {
    std::uint64_t next = 0;
    const auto normal = [&] { return random_normal(seed, next++); };
    Eigen::VectorXd drawn(root_.cols());
    for (auto& one : drawn) one = normal();
    Eigen::VectorXd errors = root_ * drawn;
    double last = 0.0;
    for (std::size_t c = 0; c < comparison_.inputs.size(); ++c) {
      // What is not a line in an input follows the same draw; its column is √2 times as large (compare()).
      const bool squared = comparison_.inputs[c].ends_with(kCurvature);
      last = squared ? last * last * M_SQRT1_2 : normal();
      errors += last * comparison_.gap.believed.col(static_cast<Eigen::Index>(c));
    }
    return errors;
  }

 private:
  const Comparison& comparison_;
  Eigen::MatrixXd root_;
};

std::vector<Replayed> replay_member(const Experiment& experiment, const BankPlan& plan,
                                    const BankFeatures& features, const Priors& priors, int member,
                                    int draws) {
  const auto [design, held] = features.held_out(member, draws, kMoreBaselines * draws);
  const Comparison learnt = compare(experiment, plan, design);
  const Weigher weigher(learnt.gap, learnt.signatures, learnt.together, priors, Pairs::run);
  const Errors errors(learnt);
  std::vector<Eigen::VectorXd>
      baselines;  // of the size of the runs, which may be smaller than the observed one
  for (const auto& run : design.runs)
    if (run.id.empty()) baselines.push_back(run.values);
  const Eigen::VectorXd mean = mean_row(baselines, learnt.simulated.size());
  std::vector<Replayed> found;
  std::vector<Eigen::VectorXd> observed;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const auto& [run, changes] = held[k];
    Replayed one{member, {}, {}};
    for (const auto& [id, theta] : changes)
      if (is_effect(id) && !weigher.absent(id, theta)) one.truth[id] = theta;
    found.push_back(std::move(one));
    observed.push_back(run.values - mean +
                       errors.draw(kSeedsOfMember * static_cast<std::uint64_t>(member) + k));
  }
  auto said = weigher(observed, kNegligible);
  for (std::size_t k = 0; k < found.size(); ++k) found[k].said = std::move(said[k]);
  return found;
}

}  // namespace

std::vector<Replayed> replay(const Experiment& experiment, const BankPlan& plan, const BankFeatures& features,
                             const Priors& priors, int draws) {
  const auto members = features.members();
  std::vector<std::vector<Replayed>> of_members(members.size());
  for_blocks(members.size(), 1, [&](std::size_t m, std::size_t) {
    of_members[m] = replay_member(experiment, plan, features, priors, members[m], draws);
  });
  std::vector<Replayed> all;
  for (auto& one : of_members) std::move(one.begin(), one.end(), std::back_inserter(all));
  return all;
}

}  // namespace pendular::diagnosis
