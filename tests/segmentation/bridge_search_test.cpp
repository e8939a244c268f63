#include "segmentation/bridges/bridge_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "balls.h"
#include "base/random.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "phantom/phantom.h"
#include "picture.h"
#include "scratch.h"
#include "segmentation/bridges/crevice.h"
#include "segmentation/bridges/neck_statistics.h"
#include "segmentation/qa/qa.h"
#include "segmentation/segment.h"

namespace pendular::segmentation {
namespace {

/// A packing in which three of ten near pairs have no bridge.
Packing bridged_packing() {
  Sample sample;
  sample.specimen.diameter = sample.specimen.height = 1.1e-3;
  sample.specimen.volume_fraction = 0.55;
  Packing packing = generate_packing(sample, 3);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * mean_diameter(packing.beads));
  for (std::size_t k = 0; k < packing.bridges.size(); ++k)
    if (random_uniform(9, k) < 0.3) packing.bridges[k].state = BridgeState::none;
  phantom::draw_neck_diameters(packing, sample, 1);
  return packing;
}

const Packing& truth() {
  static const Packing packing = bridged_packing();
  return packing;
}

Volume phantom(double contrast, double noise) {
  Sample::Phantom look;
  look.voxel = 5e-6, look.noise = noise, look.correlated_noise = 0.0, look.polymer_contrast = contrast;
  return phantom::make_phantom(truth(), look, 2);
}

Segmentation measured(double contrast, double noise, double false_discoveries = 0.05) {
  SegmentOptions options;
  options.bridges = {false_discoveries, true};
  return segment(phantom(contrast, noise), options);
}

const Segmentation& result_at_low_noise() {
  static const Segmentation result = measured(0.3, 0.1);
  return result;
}

/// What was found of each true pair, lengths in m.
struct Recovery {
  double bridges = 0.0, found = 0.0, invented = 0.0, said_none = 0.0, wrongly_none = 0.0;
  std::vector<double> true_diameters, diameters, pulls;

  double recall() const { return found / bridges; }
  double false_discoveries() const { return invented / std::max(1.0, found + invented); }
};

Recovery recovery_of(const Segmentation& result) {
  std::map<int, int> place;  // of found beads among the true ones
  for (std::size_t n = 0; n < result.beads.size(); ++n)
    for (std::size_t t = 0; t < truth().beads.size(); ++t)
      if ((result.beads[n].centre - truth().beads[t].centre).norm() < 20e-6)
        place[static_cast<int>(n)] = static_cast<int>(t);
  std::map<std::pair<int, int>, double> diameters;
  for (const auto& bridge : truth().bridges)
    if (bridge.state != BridgeState::none) diameters[{bridge.i, bridge.j}] = bridge.diameter;
  Recovery recovery;
  recovery.bridges = static_cast<double>(diameters.size());
  for (const auto& bridge : result.bridges) {
    const auto found = diameters.find(std::minmax(place.at(bridge.i), place.at(bridge.j)));
    const bool real = found != diameters.end();
    if (bridge.state == BridgeState::none) ++recovery.said_none, recovery.wrongly_none += real;
    if (bridge.state != BridgeState::bridge) continue;
    real ? ++recovery.found : ++recovery.invented;
    if (!real) continue;
    recovery.true_diameters.push_back(found->second);
    recovery.diameters.push_back(bridge.diameter);
    recovery.pulls.push_back((bridge.diameter - found->second) / bridge.sigma_diameter);
  }
  return recovery;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double rms(const std::vector<double>& values) {
  double square = 0.0;
  for (const double v : values) square += v * v;
  return std::sqrt(square / static_cast<double>(values.size()));
}

double spread(std::vector<double> values) {
  const double middle = mean(values);
  for (double& v : values) v -= middle;
  return rms(values);
}

TEST(BridgeSearch, FindsAndMeasuresTheNecksOfAPhantom) {
  const Segmentation& result = result_at_low_noise();
  const Recovery recovery = recovery_of(result);
  ASSERT_GT(recovery.bridges, 200.0);
  EXPECT_GE(recovery.recall(), 0.95);
  EXPECT_LE(recovery.false_discoveries(), 0.05);
  EXPECT_LE(recovery.wrongly_none, 0.05 * recovery.said_none + 3.0);
  std::vector<double> errors;
  for (std::size_t k = 0; k < recovery.diameters.size(); ++k)
    errors.push_back(recovery.diameters[k] / recovery.true_diameters[k] - 1.0);
  EXPECT_LE(rms(errors), 0.05);
  EXPECT_NEAR(mean(recovery.diameters) / mean(recovery.true_diameters), 1.0, 0.02);
  EXPECT_NEAR(spread(recovery.diameters) / spread(recovery.true_diameters), 1.0, 0.03);
  EXPECT_NEAR(rms(recovery.pulls), 1.0, 0.2);
  ASSERT_TRUE(result.measured && result.measured->polymer_seen);
  EXPECT_NEAR(result.measured->contrast, 0.3, 0.01);
  EXPECT_NEAR(result.measured->share, 0.7, 0.06);
}

TEST(BridgeSearch, FindsTheNecksThatItPutsIn) {
  const auto& injected = result_at_low_noise().measured->injected;
  ASSERT_EQ(injected.size(), 8u);
  for (const auto& size : injected) {
    ASSERT_GT(size.injected, 5u);
    if (size.diameter < 48e-6) continue;  // between beads that touch there is hardly any polymer to see
    EXPECT_GT(size.found, 0.9);
    EXPECT_NEAR(size.measured, size.diameter, 0.05 * size.diameter);
    EXPECT_LT(size.rms_error, 0.08 * size.diameter);
  }
}

TEST(BridgeSearch, ShowsWhatItSaw) {
  const pendular::test::ScratchFolder folder;
  write_qa(folder.path(), phantom(0.3, 0.1), result_at_low_noise());
  EXPECT_GT(test::drawn_share(test::picture(folder / "contacts.png")), 0.3);
  // Where the necks are, the mean over bridges is brighter than that over pairs without.
  const cv::Mat mean = cv::imread((folder / "mean_residuals.png").string(), cv::IMREAD_GRAYSCALE);
  const int side = (mean.cols - 20) / 2;
  const auto about_the_neck = [&](int left) {
    return cv::mean(mean(cv::Rect(left + side * 47 / 100, 30 + side / 4, side * 6 / 100, side / 8)))[0];
  };
  EXPECT_GT(about_the_neck(0), about_the_neck(side + 20) + 15.0);
}

TEST(BridgeSearch, KeepsTheShareOfFalseDiscoveriesInNoise) {
  const Recovery recovery = recovery_of(measured(0.15, 0.3));
  EXPECT_GT(recovery.found, 0.5 * recovery.bridges);
  EXPECT_LE(recovery.false_discoveries(), 0.05 + 2.0 * std::sqrt(0.05 / recovery.found));
}

TEST(BridgeSearch, WithoutContrastItCannotTell) {
  const Segmentation result = measured(0.0, 0.1);
  ASSERT_TRUE(result.measured);
  EXPECT_FALSE(result.measured->polymer_seen);
  EXPECT_EQ(result.measured->undetermined, result.bridges.size());
  for (const auto& bridge : result.bridges) {
    EXPECT_EQ(bridge.state, BridgeState::undetermined);
    EXPECT_EQ(bridge.diameter, 0.0);
  }
}

/// A neck between two balls from bodies cut into points and averaged over a Gaussian, by no formula of the
/// program's.
Volume pair_by_points(double neck_radius, double contrast, double blur) {
  constexpr int n = 60, fine = 3;
  constexpr double radius = 15.0;
  const Vec3 a(14.3, 29.6, 30.2), b(44.8, 30.3, 29.9), axis = (b - a).normalized();
  const int m = n * fine;
  std::vector<float> body(static_cast<std::size_t>(m) * m * m);
  const auto at = [m](int i, int j, int k) {
    return (static_cast<std::size_t>(k) * m + static_cast<std::size_t>(j)) * m + static_cast<std::size_t>(i);
  };
  for (int k = 0; k < m; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) {
        const Vec3 p = (Vec3(i, j, k) + Vec3::Constant(0.5)) / fine - Vec3::Constant(0.5);
        const double along = axis.dot(p - a), across = (p - a - along * axis).norm();
        const bool glass = (p - a).norm() < radius || (p - b).norm() < radius;
        const bool neck = across < neck_radius && along > 0.0 && along < (b - a).norm();
        body[at(i, j, k)] = glass ? 1.0F : neck ? static_cast<float>(contrast) : 0.0F;
      }
  std::vector<float> weights;
  const int reach = static_cast<int>(std::ceil(4.0 * blur * fine));
  float sum = 0.0F;
  for (int k = -reach; k <= reach; ++k) {
    weights.push_back(static_cast<float>(std::exp(-0.5 * std::pow(k / (blur * fine), 2))));
    sum += weights.back();
  }
  for (int axis_number = 0; axis_number < 3; ++axis_number) {
    const std::vector<float> before = body;
    for (int k = 0; k < m; ++k)
      for (int j = 0; j < m; ++j)
        for (int i = 0; i < m; ++i) {
          float total = 0.0F;
          for (int o = -reach; o <= reach; ++o) {
            int q[3] = {i, j, k};
            q[axis_number] = std::clamp(q[axis_number] + o, 0, m - 1);
            total += weights[static_cast<std::size_t>(o + reach)] * before[at(q[0], q[1], q[2])];
          }
          body[at(i, j, k)] = total / sum;
        }
  }
  std::vector<std::uint16_t> pixels;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        double share = 0.0;
        for (int c = 0; c < fine * fine * fine; ++c)
          share += body[at(fine * i + c % fine, fine * j + c / fine % fine, fine * k + c / fine / fine)];
        share /= fine * fine * fine;
        pixels.push_back(static_cast<std::uint16_t>(
            std::lround(10000.0 + 20000.0 * (share + 0.05 * random_normal(4, pixels.size())))));
      }
  return {{n, n, n}, 1e-6, Vec3::Zero(), pixels};
}

TEST(Crevice, MeasuresANeckThatWasMadeOfPoints) {
  for (const double neck : {4.0, 6.0}) {
    const double blur = 1.0;
    const Volume volume = pair_by_points(neck, 0.3, blur);
    std::vector<GreyBall> balls = {{Vec3(14.3, 29.6, 30.2), 15.0, 20000.0, 10000.0},
                                   {Vec3(44.8, 30.3, 29.9), 15.0, 20000.0, 10000.0}};
    const BallPair pair{0, 1, (balls[0].centre - balls[1].centre).norm() - 30.0, 15.0};
    ImageKnowledge knowledge;
    knowledge.blur = std::hypot(blur, std::sqrt(1.0 / 12.0));
    knowledge.noise_variance = std::pow(0.05 * 20000.0, 2);
    const NeckTemplates templates(std::vector{pair}, knowledge.blur);
    const auto evidence = neck_evidence(volume, balls, pair, {}, {}, knowledge, templates);
    ASSERT_TRUE(evidence);
    const NeckPopulation population{0.3, 0.0, 0.5, 5.0, 3.0, 0.0};
    const NeckVerdict verdict = neck_verdict(*evidence, pair.radius, population);
    EXPECT_GT(verdict.probability, 0.99);
    EXPECT_NEAR(verdict.radius, neck, 3.0 * verdict.sigma_radius + 0.02 * neck);
    EXPECT_LT(verdict.sigma_radius, 0.05 * neck);
  }
}

TEST(NeckStates, KeepTheExpectedShareOfWrongOnes) {
  std::vector<double> probabilities;
  for (std::size_t k = 0; k < 1000; ++k) probabilities.push_back(random_uniform(3, k));
  const auto states = neck_states(probabilities, 0.1);
  double wrong = 0.0, bridges = 0.0, none = 0.0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (states[k] == BridgeState::bridge) ++bridges, wrong += 1.0 - probabilities[k];
    none += states[k] == BridgeState::none;
  }
  EXPECT_NEAR(wrong / bridges, 0.1, 0.005);
  EXPECT_NEAR(bridges, 200.0, 40.0);
  EXPECT_NEAR(none, 200.0, 40.0);
  for (const BridgeState state : neck_states(std::vector(50, 0.5), 0.05))
    EXPECT_EQ(state, BridgeState::undetermined);
}

}  // namespace
}  // namespace pendular::segmentation
