#include "diagnosis/inference/replay.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/parallel.h"
#include "base/random.h"
#include "diagnosis/bank/mean_row.h"
#include "diagnosis/inference/weigher.h"
#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kNegligible = 12.0;     // evidence, as a logarithm, below the best one's
constexpr std::size_t kLeftOutRuns = 3;  // of each effect
constexpr std::size_t kPairsOfMember = 5;
constexpr std::uint64_t kSeedsOfMember = 1000000, kSeedOfPairs = 500000;

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

/// The runs of each effect that are diagnosed without it: places among the points of a plan.
std::vector<std::size_t> runs_to_leave_out(const BankPlan& plan) {
  std::map<std::string, std::vector<std::size_t>> runs;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const DesignPoint& point = plan.points[k];
    if (is_effect(point.id) && !point.at_fit && !point.scans_only && point.whole != plan.scaled())
      runs[point.id].push_back(k);
  }
  std::vector<std::size_t> chosen;
  for (auto& [id, points] : runs) {
    std::stable_sort(points.begin(), points.end(), [&](std::size_t a, std::size_t b) {
      return std::fabs(plan.points[a].theta) < std::fabs(plan.points[b].theta);
    });
    std::set<std::size_t> ranks;
    for (std::size_t part = 1; part <= kLeftOutRuns; ++part)
      ranks.insert(part * (points.size() - 1) / kLeftOutRuns);
    for (const std::size_t rank : ranks) chosen.push_back(points[rank]);
  }
  return chosen;
}

/// Whether other members tell what a run's effects do: of a pair where they were run together on another.
bool known(const Changes& truth, const std::vector<Together>& together) {
  return truth.size() < 2 || std::any_of(together.begin(), together.end(), [&](const Together& pair) {
           return truth.contains(pair.a) && truth.contains(pair.b);
         });
}

/// A diagnosis makes runs at pairs that may lead (leading_points()), after which those that were chance are
/// less probable: in its replay the others are as good as run.
std::vector<Hypothesis> as_if_run(std::vector<Hypothesis> said) {
  for (auto& h : said) h.run = h.run || h.probability >= kThresholds.leads;
  return said;
}

/// Diagnoses a run of one effect by a library that lacks the effect.
Replayed without_its_effect(const Replayed& run, const Eigen::VectorXd& observed, Comparison learnt,
                            const Priors& priors) {
  const std::string effect = run.truth.begin()->first;
  std::erase_if(learnt.signatures, [&](const Signature& one) { return one.id == effect; });
  std::erase_if(learnt.together, [&](const Together& one) { return one.a == effect || one.b == effect; });
  const Weigher weigher(learnt.gap, learnt.signatures, learnt.together, priors, Pairs::leading);
  return {run.member, run.truth, as_if_run(weigher({observed}, kNegligible).front()), effect};
}

/// Places of runs of one effect each, in a drawn order: a run, and one whose effect is added to it.
std::vector<std::pair<std::size_t, std::size_t>> pairs_among(const std::vector<Replayed>& runs,
                                                             std::uint64_t seed) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (runs[k].truth.size() == 1) order.emplace_back(random_normal(seed, k), k);
  std::sort(order.begin(), order.end());
  std::vector<std::pair<std::size_t, std::size_t>> found;
  while (!order.empty() && found.size() < kPairsOfMember) {
    const std::size_t first = order.front().second;
    order.erase(order.begin());
    const auto other = std::find_if(order.begin(), order.end(), [&](const auto& next) {
      return runs[next.second].truth.begin()->first != runs[first].truth.begin()->first;
    });
    if (other == order.end()) continue;
    found.emplace_back(first, other->second);
    order.erase(other);
  }
  return found;
}

/// What the second of two effects adds to the first, as learnt.
Eigen::VectorXd added(const Comparison& learnt, const Changes& first, const Changes& second) {
  Magnitudes magnitudes;
  magnitudes[first.begin()->first].mean = first.begin()->second;
  const Eigen::VectorXd without = left_by(learnt, magnitudes);
  magnitudes[second.begin()->first].mean = second.begin()->second;
  return without - left_by(learnt, magnitudes);
}

/// Diagnoses pairs that are put together from a member's replayed runs.
std::vector<Replayed> put_together(const std::vector<Replayed>& runs,
                                   const std::vector<Eigen::VectorXd>& observed, const Comparison& learnt,
                                   const Weigher& weigher, int member) {
  std::vector<Replayed> found;
  std::vector<Eigen::VectorXd> together;
  for (const auto& [a, b] :
       pairs_among(runs, kSeedsOfMember * static_cast<std::uint64_t>(member) + kSeedOfPairs)) {
    found.push_back({member, runs[a].truth, {}});
    found.back().truth.insert(runs[b].truth.begin(), runs[b].truth.end());
    found.back().put_together = true;
    together.push_back(observed[a] + added(learnt, runs[a].truth, runs[b].truth));
  }
  if (found.empty()) return found;
  auto said = weigher(together, kNegligible);
  for (std::size_t k = 0; k < found.size(); ++k) found[k].said = as_if_run(std::move(said[k]));
  return found;
}

std::vector<Replayed> replay_member(const Experiment& experiment, const BankPlan& plan,
                                    const BankFeatures& features, const Priors& priors, int member, int draws,
                                    Replays what, const std::vector<std::size_t>& left_out) {
  const auto [design, held] = features.held_out(member, draws);
  const Comparison learnt = compare(experiment, plan, design);
  const Weigher weigher(learnt.gap, learnt.signatures, learnt.together, priors, Pairs::leading);
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
    if (!known(one.truth, learnt.together)) continue;
    found.push_back(std::move(one));
    observed.push_back(run.values - mean +
                       errors.draw(kSeedsOfMember * static_cast<std::uint64_t>(member) + k));
  }
  auto said = weigher(observed, kNegligible);
  for (std::size_t k = 0; k < found.size(); ++k) found[k].said = as_if_run(std::move(said[k]));
  std::vector<Replayed> pairs;
  if (what == Replays::all) pairs = put_together(found, observed, learnt, weigher, member);
  for (const std::size_t at : left_out) {
    const DesignPoint& point = plan.points[at];
    const auto run = std::find_if(found.begin(), found.end(),
                                  [&](const Replayed& one) { return one.truth == point.changes; });
    if (point.member == member && run != found.end() && learnt.signatures.size() > 1)
      found.push_back(
          without_its_effect(*run, observed[static_cast<std::size_t>(run - found.begin())], learnt, priors));
  }
  std::move(pairs.begin(), pairs.end(), std::back_inserter(found));
  return found;
}

}  // namespace

std::vector<Replayed> replay(const Experiment& experiment, const BankPlan& plan, const BankFeatures& features,
                             Priors priors, int draws, Replays what) {
  priors.unknown = 0.0;  // judged by what replayed runs leave (promise_of())
  const auto chosen = what == Replays::all ? runs_to_leave_out(plan) : std::vector<std::size_t>{};
  const auto members = features.members();
  std::vector<std::vector<Replayed>> of_members(members.size());
  for_blocks(members.size(), 1, [&](std::size_t m, std::size_t) {
    of_members[m] = replay_member(experiment, plan, features, priors, members[m], draws, what, chosen);
  });
  std::vector<Replayed> all;
  for (auto& one : of_members) std::move(one.begin(), one.end(), std::back_inserter(all));
  return all;
}

}  // namespace pendular::diagnosis
