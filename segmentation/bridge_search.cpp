#include "segmentation/bridge_search.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "packing/neighbours.h"
#include "segmentation/neck_injection.h"

namespace pendular {
namespace {

constexpr double kReach = 1.0;  // of the typical radius, within which other balls may hide a crevice
constexpr std::size_t kMostForPopulation = 4000;
constexpr double kControlFrom = 0.25, kControlTo = 0.45;  // gaps over the radius: of pairs without a bridge
constexpr std::size_t kMostControls = 2000;
constexpr std::size_t kLeastHosts = 24, kMostHosts = 800;
constexpr double kLeastNoise = 1e-8;  // squared grey values; a picture may have no noise at all

std::vector<GreyBall> balls_of(const FittedBeads& fitted) {
  std::vector<GreyBall> balls;
  for (const auto& fit : fitted.fits) balls.push_back(fit.ball);
  return balls;
}

BallPair ball_pair(const std::vector<GreyBall>& balls, int i, int j) {
  const GreyBall &a = balls[i], &b = balls[j];
  return {i, j, (a.centre - b.centre).norm() - a.radius - b.radius,
          2.0 * a.radius * b.radius / (a.radius + b.radius)};
}

std::vector<IndexPair> near_pairs(const std::vector<GreyBall>& balls, double max_gap) {
  std::vector<Vec3> centres;
  std::vector<double> diameters;
  for (const auto& ball : balls) centres.push_back(ball.centre), diameters.push_back(2.0 * ball.radius);
  return pairs_within(centres, diameters, max_gap);
}

double typical_radius(const std::vector<GreyBall>& balls) {
  double sum = 0.0;
  for (const auto& ball : balls) sum += ball.radius;
  return sum / static_cast<double>(balls.size());
}

/// Pairs too far apart for a bridge, at most some thousand of them.
std::vector<BallPair> controls(const std::vector<GreyBall>& balls, double radius) {
  std::vector<BallPair> all;
  for (const auto& [i, j] : near_pairs(balls, kControlTo * radius))
    if (const BallPair pair = ball_pair(balls, i, j); pair.gap > kControlFrom * radius) all.push_back(pair);
  std::vector<BallPair> some;
  const std::size_t step = all.size() / kMostControls + 1;
  for (std::size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

/// The balls that may hide each pair's crevice.
std::vector<std::vector<int>> near_of(const std::vector<GreyBall>& balls,
                                      const std::vector<BallPair>& pairs) {
  std::vector<std::vector<int>> near(balls.size()), of_pairs;
  for (const auto& [i, j] : near_pairs(balls, kReach * typical_radius(balls)))
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
  Progress progress(name, static_cast<double>(pairs.size()));
  constexpr std::size_t batch = 256;
  for (std::size_t first = 0; first < pairs.size(); first += batch) {
    stop_if_interrupted();
    const std::size_t last = std::min(pairs.size(), first + batch);
    for_blocks(last - first, 1, [&](std::size_t n, std::size_t) {
      found[first + n] =
          neck_evidence(volume, balls, pairs[first + n], near[first + n], container, knowledge, templates);
    });
    progress.update(static_cast<double>(last));
  }
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
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle / 0.6745;
}

ImageKnowledge knowledge_of(const FittedBeads& fitted) {
  double square = 0.0;
  for (const auto& fit : fitted.fits)
    square += fit.sigma_radius * fit.sigma_radius + 0.5 * fit.sigma_centre * fit.sigma_centre;
  ImageKnowledge knowledge;
  knowledge.blur = fitted.blur;
  knowledge.sigma_blur = 0.02 * fitted.blur;
  knowledge.sigma_radius = std::max(1e-3, std::sqrt(square / static_cast<double>(fitted.fits.size())));
  knowledge.noise_variance =
      std::max(fitted.noise.sd * fitted.noise.sd, kLeastNoise) * correlated_volume(fitted.noise);
  return knowledge;
}

/// At most some hundred of the pairs that have no bridge, evenly among them.
std::vector<BallPair> hosts_of(const std::vector<Bridge>& pairs, const std::vector<BallPair>& looked_at) {
  std::vector<BallPair> all, some;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs[k].state == BridgeState::none) all.push_back(looked_at[k]);
  if (all.size() < kLeastHosts) return {};
  const std::size_t step = all.size() / kMostHosts + 1;
  for (std::size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

std::vector<InjectedNecks> in_metres(const std::vector<NeckRecovery>& points, double spacing) {
  std::vector<InjectedNecks> all;
  for (const auto& p : points)
    all.push_back(
        {2.0 * spacing * p.radius, p.injected, p.found, 2.0 * spacing * p.mean, 2.0 * spacing * p.rms_error});
  return all;
}

}  // namespace

BridgeSummary measure_bridges(const Volume& volume, const FittedBeads& fitted,
                              const std::optional<Container>& container, const BridgeOptions& options,
                              std::vector<Bridge>& pairs) {
  BridgeSummary summary;
  summary.pairs = pairs.size();
  const auto balls = balls_of(fitted);
  std::vector<BallPair> looked_at;
  for (const auto& pair : pairs) looked_at.push_back(ball_pair(balls, pair.i, pair.j));
  ImageKnowledge knowledge = knowledge_of(fitted);
  const double white = std::max(fitted.noise.sd * fitted.noise.sd, kLeastNoise);
  summary.noise_scatter = scatter_of(evidence_of(volume, balls, controls(balls, typical_radius(balls)),
                                                 container, knowledge, "gaps without bridges"));
  // Independent noise is the least there can be.
  knowledge.noise_variance =
      std::max(knowledge.noise_variance * summary.noise_scatter * summary.noise_scatter, white);
  const auto evidence = evidence_of(volume, balls, looked_at, container, knowledge, "bridges");

  std::vector<NeckEvidence> seen;
  std::vector<double> radii;
  const std::size_t step = pairs.size() / kMostForPopulation + 1;
  for (std::size_t k = 0; k < pairs.size(); k += step)
    if (evidence[k]) seen.push_back(*evidence[k]), radii.push_back(looked_at[k].radius);
  const auto population = neck_population(seen, radii);
  std::vector<std::size_t> judged;
  std::vector<double> probabilities;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Bridge& pair = pairs[k];
    pair.state = BridgeState::undetermined;
    pair.probability = population ? population->share : 0.5;
    if (!evidence[k]) ++summary.unseen;
    if (!evidence[k] || !population) continue;
    const NeckVerdict verdict = neck_verdict(*evidence[k], looked_at[k].radius, *population);
    pair.probability = verdict.probability;
    pair.diameter = 2.0 * volume.spacing * verdict.radius;
    pair.sigma_diameter = 2.0 * volume.spacing * verdict.sigma_radius;
    judged.push_back(k), probabilities.push_back(verdict.probability);
  }
  const auto states = neck_states(probabilities, options.false_discoveries);
  for (std::size_t k = 0; k < judged.size(); ++k) pairs[judged[k]].state = states[k];
  for (auto& pair : pairs) {
    summary.bridges += pair.state == BridgeState::bridge;
    summary.none += pair.state == BridgeState::none;
    summary.undetermined += pair.state == BridgeState::undetermined;
    if (pair.state == BridgeState::none) pair.diameter = pair.sigma_diameter = 0.0;
  }
  if (!population) return summary;
  summary.polymer_seen = true;
  summary.contrast = population->contrast, summary.sigma_contrast = population->sigma_contrast;
  summary.share = population->share;
  summary.diameter = 2.0 * volume.spacing * population->mean;
  summary.diameter_sd = 2.0 * volume.spacing * population->sd;
  if (!options.calibrate) return summary;
  double threshold = 1.0;
  for (const auto& pair : pairs)
    if (pair.state == BridgeState::bridge) threshold = std::min(threshold, pair.probability);
  const auto hosts = hosts_of(pairs, looked_at);
  summary.injected = in_metres(recover_injected(volume, balls, hosts, near_of(balls, hosts), container,
                                                knowledge, *population, threshold),
                               volume.spacing);
  return summary;
}

}  // namespace pendular
