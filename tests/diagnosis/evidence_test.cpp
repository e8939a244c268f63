#include "diagnosis/inference/evidence.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/random.h"
#include "diagnosis/inference/reduced_space.h"

namespace pendular::diagnosis {
namespace {

constexpr int kFeatures = 8;

Eigen::VectorXd draw(std::uint64_t seed, int size = kFeatures) {
  Eigen::VectorXd v(size);
  for (int k = 0; k < size; ++k) v[k] = random_normal(seed, static_cast<std::uint64_t>(k));
  return v;
}

/// Effects whose signatures at scale one are `strength` noises long, in directions of their own.
std::vector<Signature> effects(int count, double strength) {
  std::vector<Signature> all;
  for (int k = 0; k < count; ++k) {
    Signature s;
    s.id = std::string(1, static_cast<char>('a' + k));
    s.powers = {strength * draw(100 + static_cast<std::uint64_t>(k)).normalized(),
                0.1 * strength * draw(200 + static_cast<std::uint64_t>(k)).normalized()};
    s.lowest = 0.0, s.highest = 3.0, s.scale = 1.0;
    all.push_back(s);
  }
  return all;
}

Gap gap_of(const Eigen::VectorXd& values) {
  return {
      values, Eigen::MatrixXd::Identity(kFeatures, kFeatures), 0.0, {}, Eigen::MatrixXd::Zero(kFeatures, 0)};
}

double probability(const std::vector<Hypothesis>& all, const std::string& id) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& h) { return h.id == id; });
  return found == all.end() ? 0.0 : found->probability;
}

TEST(Evidence, OfOneFeatureIsItsIntegralOverMagnitudes) {
  // One feature of value 3, one effect of slope 2, all θ from −8 to 8 alike. The response is known to a tenth
  // of itself, and three tenths of that square lie in no direction: ∫ N(3; 2θ, 1 + 1.3 (0.2 θ)²) dθ / 16,
  // here by the trapezoidal rule.
  double evidence = 0.0, first = 0.0, up_to = 0.0;
  const double step = 1e-4;
  const auto density = [](double theta) {
    const double variance = 1.0 + 1.3 * std::pow(0.2 * theta, 2);
    return std::exp(-0.5 * std::pow(3.0 - 2.0 * theta, 2) / variance) / std::sqrt(2.0 * M_PI * variance);
  };
  for (double theta = -8.0; theta < 8.0; theta += step) {
    evidence += step * density(theta) / 16.0, first += step * theta * density(theta) / 16.0;
  }
  double low = -8.0;
  for (; up_to < 0.05 * evidence; low += step) up_to += step * density(low) / 16.0;
  Signature s;
  s.id = "a";
  s.powers = {Eigen::VectorXd::Constant(1, 2.0)};
  s.lowest = -8.0, s.highest = 8.0, s.scale = 1.0;
  const Gap gap = {Eigen::VectorXd::Constant(1, 3.0),
                   Eigen::MatrixXd::Constant(1, 1, 1.0),
                   0.0,
                   {},
                   Eigen::MatrixXd::Zero(1, 0)};
  for (const auto& h : weigh(gap, {s})) {
    if (h.id == "none") {
      EXPECT_NEAR(h.log_evidence, -4.5 - 0.5 * std::log(2.0 * M_PI), 1e-12);
    }
    if (h.id != "a") continue;
    EXPECT_NEAR(h.log_evidence, std::log(evidence), 0.015);  // of cells that are coarse far from the peak
    EXPECT_NEAR(h.magnitudes[0].mean, first / evidence, 1e-3);
    EXPECT_NEAR(h.magnitudes[0].interval_90.first, low, 0.03);
  }
}

/// One feature of value 3, and an effect of which any of these slopes may be the response.
Hypothesis of_slopes(const std::vector<double>& slopes) {
  Signature s;
  s.id = "a";
  const auto response = [](double slope) {
    Response found;
    found.powers = {Eigen::VectorXd::Constant(1, slope)};
    return found;
  };
  static_cast<Response&>(s) = response(slopes.front());
  for (std::size_t k = 1; k < slopes.size(); ++k) s.others.push_back(response(slopes[k]));
  s.lowest = 0.0, s.highest = 8.0, s.scale = 1.0;
  Gap gap;
  gap.values = Eigen::VectorXd::Constant(1, 3.0), gap.covariance = Eigen::MatrixXd::Identity(1, 1);
  gap.believed = Eigen::MatrixXd::Zero(1, 0);
  for (const auto& h : weigh(gap, {s}))
    if (h.id == "a") return h;
  return {};
}

// Of an effect that acts in one of two ways, as likely before: the mean evidence, and the mean magnitude by
// their evidences.
TEST(Evidence, OfTwoReadingsIsTheirMean) {
  const Hypothesis steep = of_slopes({2.0}), flat = of_slopes({0.5}), either = of_slopes({2.0, 0.5});
  const double of_steep = std::exp(steep.log_evidence), of_flat = std::exp(flat.log_evidence);
  EXPECT_NEAR(std::exp(either.log_evidence), 0.5 * (of_steep + of_flat), 0.005 * of_steep);
  const double mean =
      (of_steep * steep.magnitudes[0].mean + of_flat * flat.magnitudes[0].mean) / (of_steep + of_flat);
  EXPECT_NEAR(either.magnitudes[0].mean, mean, 0.02);
  EXPECT_EQ(either.magnitudes[0].reading, of_steep > of_flat ? 0u : 1u);
  EXPECT_EQ(of_slopes({0.5, 2.0}).magnitudes[0].reading, of_steep > of_flat ? 1u : 0u);
}

TEST(Evidence, ResponsesOfExactFeaturesHaveNoErrors) {
  // As above with slope 3 and 40 %, and a second feature of value 1 that does 4 θ: without an error it says
  // that θ is small, whatever the first one does.
  double evidence = 0.0, first = 0.0;
  const double step = 1e-4;
  for (double theta = -8.0; theta < 8.0; theta += step) {
    const double variance = 1.0 + 1.3 * std::pow(0.4 * 3.0 * theta, 2);
    const double density = std::exp(-0.5 * std::pow(6.0 - 3.0 * theta, 2) / variance) /
                           std::sqrt(2.0 * M_PI * variance) *
                           std::exp(-0.5 * std::pow(1.0 - 4.0 * theta, 2)) / std::sqrt(2.0 * M_PI);
    evidence += step * density / 16.0, first += step * theta * density / 16.0;
  }
  Gap gap{Eigen::Vector2d(1.0, 6.0), Eigen::Matrix2d::Identity(), 0.0, {}, Eigen::MatrixXd::Zero(2, 0)};
  Signature s;
  s.id = "a", s.powers = {Eigen::Vector2d(4.0, 3.0)}, s.lowest = -8.0, s.highest = 8.0, s.scale = 1.0,
  s.error = 0.4;
  const auto found = [&] {
    const auto all = weigh(gap, {s});
    return *std::find_if(all.begin(), all.end(), [](const auto& h) { return h.id == "a"; });
  };
  EXPECT_GT(found().magnitudes.front().mean, 2.0 * first / evidence);  // as if it had an error, too
  gap.exact = {0};
  EXPECT_NEAR(found().log_evidence, std::log(evidence), 0.02);
  EXPECT_NEAR(found().magnitudes.front().mean, first / evidence, 0.01);
}

TEST(Evidence, WhatIsBelowTheLeastMagnitudeIsNone) {
  auto all = effects(1, 2.0);  // at 0.6 it is 1.2 standard deviations from none
  const Gap gap = gap_of(all[0].at(0.3));
  const double wide = probability(weigh(gap, all), "a");
  all[0].least = 0.6;
  EXPECT_LT(probability(weigh(gap, all), "a"), wide);
  for (const auto& h : weigh(gap, all))
    if (h.id == "a") {
      EXPECT_GE(h.magnitudes[0].interval_90.first, 0.6);
    }
}

TEST(Evidence, AnEffectThatIsSeenBelowItsLeastMagnitudeIsNamed) {
  auto all = effects(3, 40.0);
  for (auto& one : all) one.least = 0.6;
  const auto found = weigh(gap_of(all[1].at(0.2)), all);
  EXPECT_EQ(found.front().id, "b");
  ASSERT_EQ(found.front().magnitudes.size(), 1U);
  EXPECT_NEAR(found.front().magnitudes[0].mean, 0.2, 0.03);
}

TEST(Evidence, ProbabilitiesSumToOne) {
  double sum = 0.0;
  for (const auto& h : weigh(gap_of(draw(1)), effects(5, 4.0))) sum += h.probability;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Evidence, NamesTheEffectAndCoversItsMagnitude) {
  const auto all = effects(6, 8.0);
  int named = 0, covered = 0, cases = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed, ++cases) {
    const auto& truth = all[seed % all.size()];
    const double theta = 0.6 + 1.4 * random_uniform(7, seed);
    const auto found = weigh(gap_of(truth.at(theta) + draw(1000 + seed)), all);
    named += found.front().id == truth.id;
    for (const auto& h : found)
      if (h.id == truth.id)
        covered += h.magnitudes[0].interval_90.first <= theta && theta <= h.magnitudes[0].interval_90.second;
  }
  EXPECT_GE(named, 0.9 * cases);
  // 90 % of 120, within three standard errors.
  EXPECT_NEAR(covered, 0.9 * cases, 3.0 * std::sqrt(0.09 * cases));
}

TEST(Evidence, FindsNothingWhereNothingIs) {
  const auto all = effects(6, 8.0);
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    alarms += probability(weigh(gap_of(draw(5000 + seed)), all), "none") < 0.1;
  EXPECT_LE(alarms, 10);
}

TEST(Evidence, SaysUnknownWhereNoEffectFits) {
  // Three effects of eight directions: most of what is drawn at random is outside their span.
  const auto all = effects(3, 8.0);
  int unknown = 0, sure_and_wrong = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Eigen::VectorXd outside = draw(9000 + seed);
    for (int round = 0; round < 50; ++round)
      for (const auto& s : all) outside -= s.powers[0].normalized() * s.powers[0].normalized().dot(outside);
    const auto found = weigh(gap_of(10.0 * outside.normalized() + draw(9500 + seed)), all);
    unknown += found.front().id == "unknown";
    sure_and_wrong += found.front().id != "unknown" && found.front().probability > 0.9;
  }
  EXPECT_GE(unknown, 80);
  EXPECT_LE(sure_and_wrong, 2);
}

TEST(Evidence, WhatIsWrongOnlyAmongTheKnownDirectionsIsUnknown) {
  // Two effects span three directions of eight; what is seen is far off in them and as expected outside.
  auto two = effects(2, 4.0);
  Gap gap = gap_of(Eigen::VectorXd::Zero(kFeatures));
  const ReducedSpace space(gap, two);
  ASSERT_LT(space.size(), kFeatures);
  Eigen::VectorXd seen = draw(7);
  for (const auto& effect : two) {
    const Eigen::VectorXd along = effect.at(1.0).normalized();
    seen -= 9.0 * along;  // against the sign that the effects have
  }
  gap.values = seen;
  EXPECT_GT(probability(weigh(gap, two), "unknown"), 0.9);
}

TEST(Evidence, WhatABelievedInputCanAbsorbIsNoEffect) {
  const auto all = effects(4, 8.0);
  Gap gap = gap_of(all[2].at(1.0));
  EXPECT_GT(probability(weigh(gap, all), "c"), 0.8);
  gap.believed = all[2].powers[0];
  EXPECT_EQ(weigh(gap, all).front().id, "none");
}

TEST(Evidence, AnEstimatedCovarianceIsTrustedLess) {
  // The same gap of four noises: with six degrees of freedom it is less of a surprise than with many.
  Gap gap = gap_of(Eigen::VectorXd::Constant(kFeatures, 1.5));
  const double known = probability(weigh(gap, effects(4, 8.0)), "none");
  gap.dof = 6.0;
  EXPECT_GT(probability(weigh(gap, effects(4, 8.0)), "none"), known);
}

TEST(Evidence, AnEstimatedCovarianceGivesStudentsDensity) {
  // One feature three noises off, its variance known with four degrees of freedom.
  Signature s = effects(1, 1.0).front();
  s.powers = {Eigen::VectorXd::Constant(1, 1.0)};
  const Gap gap = {Eigen::VectorXd::Constant(1, 3.0),
                   Eigen::MatrixXd::Constant(1, 1, 1.0),
                   4.0,
                   {},
                   Eigen::MatrixXd::Zero(1, 0)};
  const double student = 0.375 * std::pow(1.0 + 9.0 / 4.0, -2.5);  // 3/8 (1 + t²/4)^(-5/2)
  for (const auto& h : weigh(gap, {s}))
    if (h.id == "none") {
      EXPECT_NEAR(h.log_evidence, std::log(student), 1e-9);
    }
}

TEST(Evidence, FindsAPairAndBothMagnitudes) {
  const auto all = effects(5, 12.0);
  int found = 0;
  double first = 0.0, second = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto hypotheses = weigh(gap_of(all[1].at(1.2) + all[3].at(0.9) + draw(700 + seed)), all);
    if (hypotheses.front().id != "b+d") continue;
    ++found;
    first += hypotheses.front().magnitudes[0].mean, second += hypotheses.front().magnitudes[1].mean;
  }
  ASSERT_GE(found, 16);
  EXPECT_NEAR(first / found, 1.2, 0.2);
  EXPECT_NEAR(second / found, 0.9, 0.2);
}

TEST(Evidence, APairThatDoesNotAddIsKnownFromRunsOfBoth) {
  // Together two effects do something in a direction of its own besides.
  const auto all = effects(4, 8.0);
  const Eigen::VectorXd beyond = 6.0 * draw(55).normalized();
  const Gap gap = gap_of(all[0].at(1.0) + all[1].at(1.0) + beyond);
  const std::vector<Together> run = {{"a", "b", 1.0, 1.0, beyond}};
  const auto of_sum = weigh(gap, all), of_runs = weigh(gap, all, run);
  EXPECT_GT(probability(of_runs, "a+b"), 0.5);
  EXPECT_GT(probability(of_runs, "a+b"), probability(of_sum, "a+b"));
}

TEST(Evidence, LeadingPairsAreThoseThatWereRunAndThoseOfTheBestEffect) {
  const auto all = effects(4, 8.0);
  const std::vector<Together> run = {{"a", "b", 1.0, 1.0, Eigen::VectorXd::Zero(kFeatures)}};
  const Gap gap = gap_of(all[2].at(1.0) + draw(57));
  const auto every = weigh(gap, all, run), leading = weigh(gap, all, run, {}, Pairs::leading);
  std::set<std::string> pairs;
  for (const auto& h : leading)
    if (effects_in(h.id).size() == 2) pairs.insert(h.id);
  EXPECT_EQ(pairs, (std::set<std::string>{"a+b", "a+c", "b+c", "c+d"}));
  // What is weighed in either way is as probable beside none, but for cells that are not cut.
  EXPECT_NEAR(probability(leading, "c") / probability(leading, "none") /
                  (probability(every, "c") / probability(every, "none")),
              1.0, 1e-9);
}

TEST(Evidence, FewRunsOfAPairSayNoMoreThanTheyScatter) {
  // What four runs showed beyond the sum is off by twice the noise.
  const auto all = effects(4, 8.0);
  const Eigen::VectorXd beyond = 6.0 * draw(55).normalized(), off = 2.0 * draw(56);
  const Gap gap = gap_of(all[0].at(1.0) + all[1].at(1.0) + beyond);
  Together run{"a", "b", 1.0, 1.0, beyond + off};
  const double sure = probability(weigh(gap, all, {run}), "a+b");
  run.error = 4.0 * Eigen::MatrixXd::Identity(kFeatures, kFeatures);
  EXPECT_GT(probability(weigh(gap, all, {run}), "a+b"), 2.0 * sure);
}

// What runs at a fit have beyond responses is part of what the explanation says, and of what those say that
// are nearest to it.
TEST(Evidence, RunsAtAFitSayWhatResponsesDoNotAddUpTo) {
  const auto all = effects(4, 8.0);
  const ReducedSpace space(gap_of(Eigen::VectorXd::Zero(kFeatures)), all);
  const Eigen::VectorXd beyond = space.spanned(space.reduced(0.5 * all[1].at(1.0)));
  Gap gap = gap_of(all[0].at(1.2) + beyond);
  const Gap without = gap;
  gap.at_fit = {{"a", beyond, Eigen::MatrixXd::Zero(kFeatures, kFeatures)}};
  const auto evidence = [](const Gap& of, const std::vector<Signature>& signatures, const std::string& id) {
    for (const auto& h : weigh(of, signatures))
      if (h.id == id) return h.log_evidence;
    return 0.0;
  };
  EXPECT_LT(probability(weigh(without, all), "a"), 0.5);
  EXPECT_GT(probability(weigh(gap, all), "a"), 0.5);
  EXPECT_NEAR(evidence(gap, all, "a"), evidence(gap_of(all[0].at(1.2)), all, "a"), 1e-9);
  EXPECT_NEAR(evidence(gap, all, "a+b"), evidence(gap_of(gap.values - beyond), all, "a+b"), 1e-9);
  for (const char* other : {"none", "b", "c", "b+c"})
    EXPECT_EQ(evidence(gap, all, other), evidence(without, all, other)) << other;
  gap.at_fit.front().id = "none";
  for (const char* near : {"none", "b", "a+b"})
    EXPECT_NEAR(evidence(gap, all, near), evidence(gap_of(gap.values - beyond), all, near), 1e-9) << near;
}

TEST(Evidence, OfPairsItIsKnownWhetherTheyWereRun) {
  const auto all = effects(4, 4.0);
  const std::vector<Together> run = {{"c", "a", 1.0, 1.0, Eigen::VectorXd::Zero(kFeatures)}};
  for (const auto& h : weigh(gap_of(draw(41)), all, run))
    EXPECT_EQ(h.run, effects_in(h.id).size() < 2 || h.id == "a+c") << h.id;
  EXPECT_TRUE(effects_in(kOtherPairs).empty());
}

TEST(Evidence, WhatDrawsOfAnEffectDifferByIsNotHeldAgainstIt) {
  // One draw of the effect does something in a direction of its own besides what all draws do.
  auto all = effects(3, 8.0);
  const Eigen::VectorXd own = 5.0 * draw(77).normalized();
  const Gap gap = gap_of(all[0].at(1.0) + own);
  const double held = probability(weigh(gap, all), "a");
  all[0].draws = 25.0 / kFeatures * Eigen::MatrixXd::Identity(kFeatures, kFeatures);
  EXPECT_GT(probability(weigh(gap, all), "a"), 2.0 * held);
}

TEST(Evidence, WhatKnownRunsLeaveOutsideIsNoSurprise) {
  // Two effects of eight directions; runs of the bank scatter outside of them four times as far as the noise.
  const auto all = effects(2, 8.0);
  std::vector<Eigen::VectorXd> runs;
  for (std::uint64_t seed = 0; seed < 60; ++seed) runs.push_back(4.0 * draw(8000 + seed));
  Gap gap = gap_of(4.0 * draw(8100));
  for (const auto& s : all)  // nothing of the effects in it
    for (int round = 0; round < 50; ++round)
      for (const auto& power : s.powers)
        gap.values -= power.normalized() * power.normalized().dot(gap.values);
  const double surprised = probability(weigh(gap, all), "unknown");
  const ReducedSpace space(gap, all);
  for (const auto& run : runs) gap.outside.push_back(space.outside(run));
  EXPECT_GT(surprised, 0.9);
  EXPECT_LT(probability(weigh(gap, all), "unknown"), 0.5);
}

TEST(Evidence, OutsideIsWhatResponsesDoNotSpan) {
  // Two responses along the first two axes; the rest of a gap of the noise's size is χ² of what remains.
  std::vector<Signature> all = effects(2, 8.0);
  for (int k = 0; k < 2; ++k)
    all[static_cast<std::size_t>(k)].powers = {8.0 * Eigen::VectorXd::Unit(kFeatures, k)};
  const Gap gap = gap_of(Eigen::VectorXd::Zero(kFeatures));
  EXPECT_EQ(ReducedSpace(gap, all).size(), 2);
  const Eigen::VectorXd value = draw(3);
  EXPECT_NEAR(ReducedSpace(gap, all).outside(value), value.tail(kFeatures - 2).squaredNorm(), 1e-9);
}

TEST(Evidence, AlikeEffectsAreNotIsolable) {
  auto all = effects(3, 8.0);
  all[0].powers.resize(1);
  all[1].powers = {0.7 * all[0].powers[0]};
  const auto distance = isolability(gap_of(Eigen::VectorXd::Zero(kFeatures)), all);
  EXPECT_LT(distance(0, 1), 0.1);
  EXPECT_GT(distance(0, 2), 9.0);
  EXPECT_NEAR(distance(0, 3), 64.0, 1e-9);
}

TEST(Evidence, AnEffectThatOneSignShowsIsSeen) {
  auto all = effects(2, 8.0);
  all[0].powers = {0.1 * all[0].powers[0]};
  all[0].below = Response{{all[0].powers[0] * 100.0}};
  all[0].lowest = -3.0;
  const auto distance = isolability(gap_of(Eigen::VectorXd::Zero(kFeatures)), all);
  EXPECT_NEAR(distance(0, 2), 80.0 * 80.0, 1e-6);
}

}  // namespace
}  // namespace pendular::diagnosis
