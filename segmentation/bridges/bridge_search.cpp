#include "segmentation/bridges/bridge_search.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/batches.h"
#include "base/quantile.h"
#include "segmentation/bridges/neck_injection.h"

namespace pendular::segmentation {
namespace {

constexpr double kReach = 1.0;  // of the typical radius, within which other balls may hide a crevice
constexpr std::size_t kMostForPopulation = 4000;
constexpr double kControlFrom = 0.25, kControlWidth = 0.2;  // gaps over the radius: of pairs without a bridge
constexpr std::size_t kMostControls = 2000;
constexpr std::size_t kLeastHosts = 24, kMostHosts = 800;
constexpr double kLeastNoise = 1e-8;  // squared grey values; a picture may have no noise at all

double typical_radius(const std::vector<GreyBall>& balls) {
  double sum = 0.0;
  for (const auto& ball : balls) sum += ball.radius;
  return sum / static_cast<double>(balls.size());
}

/// At most so many of all, evenly among them.
template <typename Item>
std::vector<Item> some_of(const std::vector<Item>& all, std::size_t most) {
  const std::size_t step = all.size() / most + 1;
  std::vector<Item> some;
  for (std::size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

/// Pairs too far apart for a bridge, and farther than any that is looked at.
std::vector<BallPair> controls(const std::vector<GreyBall>& balls, const std::vector<BallPair>& looked_at) {
  const double radius = typical_radius(balls);
  double from = kControlFrom * radius;
  for (const auto& pair : looked_at) from = std::max(from, pair.gap);
  std::vector<BallPair> all;
  for (const auto& [i, j] : near_balls(balls, from + kControlWidth * radius))
    if (const BallPair pair = ball_pair(balls, i, j); pair.gap > from) all.push_back(pair);
  return some_of(all, kMostControls);
}

/// The balls that may hide each pair's crevice.
std::vector<std::vector<int>> near_of(const std::vector<GreyBall>& balls,
                                      const std::vector<BallPair>& pairs) {
  std::vector<std::vector<int>> near(balls.size()), of_pairs;
  for (const auto& [i, j] : near_balls(balls, kReach * typical_radius(balls)))
    near[static_cast<std::size_t>(i)].push_back(j), near[static_cast<std::size_t>(j)].push_back(i);
  for (const auto& pair : pairs) {
    std::vector<int> others = near[static_cast<std::size_t>(pair.i)];
    const auto& more = near[static_cast<std::size_t>(pair.j)];
    others.insert(others.end(), more.begin(), more.end());
    std::erase_if(others, [&](int k) { return k == pair.i || k == pair.j; });
    of_pairs.push_back(std::move(others));
  }
  return of_pairs;
}

/// The evidence of every pair's crevice, as seen in the volume.
std::vector<std::optional<NeckEvidence>> evidence_of(const Volume& volume, const std::vector<GreyBall>& balls,
                                                     const std::vector<BallPair>& pairs,
                                                     const std::optional<Container>& container,
                                                     const ImageKnowledge& knowledge,
                                                     const std::string& name) {
  const NeckTemplates templates(pairs, knowledge.blur);
  const auto near = near_of(balls, pairs);
  std::vector<std::optional<NeckEvidence>> found(pairs.size());
  for_batches(name, pairs.size(), 256, [&](std::size_t n) {
    found[n] = neck_evidence(volume, balls, pairs[n], near[n], container, knowledge, templates);
  });
  return found;
}

/// By how much the evidence at a typical neck scatters beyond what noise explains: robustly, from the median
/// deviation.
double scatter_of(const std::vector<std::optional<NeckEvidence>>& evidence) {
  std::vector<double> sizes;
  const std::size_t typical = neck_shares().size() / 2;
  for (const auto& one : evidence)
    if (one && one->d[typical] > 0.0)
      sizes.push_back(std::fabs(one->n[typical]) / std::sqrt(one->d[typical]));
  if (sizes.size() < 20) return 1.0;
  return median(std::move(sizes)) / 0.6745;
}

ImageKnowledge knowledge_of(const FittedBeads& fitted) {
  double square = 0.0;
  for (const auto& fit : fitted.fits)
    square += fit.sigma_radius * fit.sigma_radius + 0.5 * fit.sigma_centre * fit.sigma_centre;
  ImageKnowledge knowledge;
  knowledge.blur = fitted.blur;
  knowledge.sigma_blur = 0.02 * fitted.blur;
  knowledge.sigma_radius = std::max(1e-3, std::sqrt(square / static_cast<double>(fitted.fits.size())));
  knowledge.rings = fitted.rings.get();
  knowledge.noise_variance =
      std::max(fitted.noise.sd * fitted.noise.sd, kLeastNoise) * correlated_volume(fitted.noise);
  return knowledge;
}

/// At most some hundred of the pairs that have no bridge, evenly among them.
std::vector<BallPair> hosts_of(const std::vector<Bridge>& pairs, const std::vector<BallPair>& looked_at) {
  std::vector<BallPair> all;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs[k].state == BridgeState::none) all.push_back(looked_at[k]);
  return all.size() < kLeastHosts ? std::vector<BallPair>() : some_of(all, kMostHosts);
}

using Evidence = std::vector<std::optional<NeckEvidence>>;

std::optional<NeckPopulation> population_of(const Evidence& evidence,
                                            const std::vector<BallPair>& looked_at) {
  std::vector<NeckEvidence> seen;
  std::vector<double> radii;
  const std::size_t step = evidence.size() / kMostForPopulation + 1;
  for (std::size_t k = 0; k < evidence.size(); k += step)
    if (evidence[k]) seen.push_back(*evidence[k]), radii.push_back(looked_at[k].radius);
  return neck_population(seen, radii);
}

/// Contrast of what is in all crevices together, as if each held a neck of typical size, and its standard
/// error.
std::pair<double, double> mean_contrast(const Evidence& evidence) {
  const std::size_t typical = neck_shares().size() / 2;
  double n = 0.0, d = 0.0;
  for (const auto& one : evidence)
    if (one) n += one->n[typical], d += one->d[typical];
  return d > 0.0 ? std::pair(n / d, 1.0 / std::sqrt(d)) : std::pair(0.0, HUGE_VAL);
}

/// Probability, neck and state of every pair; without a population, or where nothing is seen, undetermined.
void judge(const Evidence& evidence, const std::vector<BallPair>& looked_at,
           const std::optional<NeckPopulation>& population, double spacing, double false_discoveries,
           std::vector<Bridge>& pairs) {
  std::vector<std::size_t> judged;
  std::vector<double> probabilities;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Bridge& pair = pairs[k];
    pair.state = BridgeState::undetermined;
    pair.probability = population ? population->share : 0.5;
    if (!evidence[k] || !population) continue;
    const NeckVerdict verdict = neck_verdict(*evidence[k], looked_at[k].radius, *population);
    pair.probability = verdict.probability;
    pair.diameter = 2.0 * spacing * verdict.radius;
    pair.sigma_diameter = 2.0 * spacing * verdict.sigma_radius;
    judged.push_back(k), probabilities.push_back(verdict.probability);
  }
  const auto states = neck_states(probabilities, false_discoveries);
  for (std::size_t k = 0; k < judged.size(); ++k) {
    Bridge& pair = pairs[judged[k]];
    pair.state = states[k];
    if (pair.state == BridgeState::none) pair.diameter = pair.sigma_diameter = 0.0;
  }
}

std::vector<InjectedNecks> in_metres(const std::vector<NeckRecovery>& points, double spacing) {
  std::vector<InjectedNecks> all;
  for (const auto& p : points)
    all.push_back(
        {2.0 * spacing * p.radius, p.injected, p.found, 2.0 * spacing * p.mean, 2.0 * spacing * p.rms_error});
  return all;
}

std::vector<InjectedNecks> injected_into(const Volume& volume, const std::vector<GreyBall>& balls,
                                         const std::vector<Bridge>& pairs,
                                         const std::vector<BallPair>& looked_at,
                                         const std::optional<Container>& container,
                                         const ImageKnowledge& knowledge, const NeckPopulation& population) {
  double threshold = 1.0;
  for (const auto& pair : pairs)
    if (pair.state == BridgeState::bridge) threshold = std::min(threshold, pair.probability);
  const auto hosts = hosts_of(pairs, looked_at);
  return in_metres(recover_injected(volume, balls, hosts, near_of(balls, hosts), container, knowledge,
                                    population, threshold),
                   volume.spacing);
}

}  // namespace

BridgeSummary measure_bridges(const Volume& volume, const FittedBeads& fitted,
                              const std::optional<Container>& container, const BridgeOptions& options,
                              std::vector<Bridge>& pairs) {
  const auto balls = balls_of(fitted.fits);
  std::vector<BallPair> looked_at;
  for (const auto& pair : pairs) looked_at.push_back(ball_pair(balls, pair.i, pair.j));
  ImageKnowledge knowledge = knowledge_of(fitted);
  BridgeSummary summary;
  summary.noise_scatter = scatter_of(
      evidence_of(volume, balls, controls(balls, looked_at), container, knowledge, "gaps without bridges"));
  // Independent noise is the least there can be.
  knowledge.noise_variance =
      std::max({knowledge.noise_variance * summary.noise_scatter * summary.noise_scatter,
                fitted.noise.sd * fitted.noise.sd, kLeastNoise});
  const Evidence evidence = evidence_of(volume, balls, looked_at, container, knowledge, "bridges");
  const auto population = population_of(evidence, looked_at);
  judge(evidence, looked_at, population, volume.spacing, options.false_discoveries, pairs);

  const auto count = [&](BridgeState state) {
    return static_cast<std::size_t>(std::count_if(
        pairs.begin(), pairs.end(), [state](const Bridge& pair) { return pair.state == state; }));
  };
  summary.pairs = pairs.size();
  summary.bridges = count(BridgeState::bridge);
  summary.none = count(BridgeState::none);
  summary.undetermined = count(BridgeState::undetermined);
  summary.unseen = static_cast<std::size_t>(
      std::count_if(evidence.begin(), evidence.end(), [](const auto& one) { return !one.has_value(); }));
  std::tie(summary.contrast, summary.sigma_contrast) = mean_contrast(evidence);
  if (!population) return summary;
  summary.polymer_seen = true;
  summary.contrast = population->contrast, summary.sigma_contrast = population->sigma_contrast;
  summary.share = population->share;
  summary.diameter = 2.0 * volume.spacing * population->mean;
  summary.diameter_sd = 2.0 * volume.spacing * population->sd;
  if (options.calibrate)
    summary.injected = injected_into(volume, balls, pairs, looked_at, container, knowledge, *population);
  return summary;
}

}  // namespace pendular::segmentation
