#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "micromechanics/bridge_fe.h"
#include "pipette/measure.h"
#include "pipette/phantom.h"

namespace pendular::pipette {
namespace {

Measurement measure_phantom(const Phantom& phantom, const Calibration& calibration) {
  Frame frame{0, "frame 0", phantom_frame(phantom, 0)};
  Tracker tracker(read_scene(frame.image, calibration, frame.name), calibration);
  tracker.add(frame);
  for (int k = 1; k < frames_of(phantom); ++k)
    tracker.add({k, "frame " + std::to_string(k), phantom_frame(phantom, k)});
  return std::move(tracker).finish("phantom");
}

Measurement measure_phantom(const Phantom& phantom) {
  return measure_phantom(phantom, phantom_calibration(phantom));
}

TEST(Phantom, IsInEquilibrium) {
  Phantom phantom;
  phantom.softening = 0.4;
  for (int k = 0; k < frames_of(phantom); ++k) {
    const PhantomMotion motion = phantom_motion(phantom, k);
    const double e = motion.wafer - motion.pipette;
    const double e_max = phantom.stage_travel * 0.1 / 1.1;
    EXPECT_NEAR(phantom.pipette_stiffness * motion.pipette,
                phantom.bridge_stiffness * (e - 0.5 * 0.4 * e * e / e_max), 1e-9);
  }
  EXPECT_DOUBLE_EQ(phantom_motion(phantom, 2).wafer, 0.0);
  EXPECT_DOUBLE_EQ(phantom_motion(phantom, 32).wafer, phantom.stage_travel);
}

TEST(Chain, TracksFollowTheTruthOfEveryFrame) {
  Phantom phantom;
  const Measurement m = measure_phantom(phantom);
  const PhantomMotion first = phantom_motion(phantom, 0);
  for (int k = 0; k < frames_of(phantom); ++k) {
    const PhantomMotion motion = phantom_motion(phantom, k);
    const auto& matches = m.frames[static_cast<std::size_t>(k)].matches;
    const Point drift = motion.drift - first.drift;
    EXPECT_NEAR(matches[bead_fixed].displacement.x(), motion.wafer + drift.x(), 0.05);
    EXPECT_NEAR(matches[bead_free].displacement.x(), motion.pipette + drift.x(), 0.05);
    EXPECT_NEAR(matches[tip].displacement.x(), motion.pipette + drift.x(), 0.1);
    EXPECT_NEAR(matches[reference].displacement.y(), drift.y(), 0.1);
  }
  EXPECT_NEAR(m.stage_speed / m.calibration.stage_speed, 1.0, 0.02);
}

TEST(Chain, BlackAndRepeatedFramesAreRejectedAndListed) {
  Phantom phantom;
  phantom.dropped = 14;
  const Calibration calibration = phantom_calibration(phantom);
  Tracker tracker(read_scene(phantom_frame(phantom, 0), calibration, "0"), calibration);
  long long number = 0;
  for (int k = 0; k < frames_of(phantom); ++k) {
    if (k == 40) ++number;  // one frame is not there
    tracker.add({number++, std::to_string(k), phantom_frame(phantom, k)});
    if (k == 20) tracker.add({number++, "copy", phantom_frame(phantom, k)});
  }
  const Measurement m = std::move(tracker).finish("phantom");
  EXPECT_EQ(m.frames[14].rejected, "constant or black");
  EXPECT_EQ(m.frames[21].rejected, "copy of the frame before");
  EXPECT_EQ(std::count(m.curve.used.begin(), m.curve.used.end(), 0), 2);
  EXPECT_EQ(m.missing, std::vector<long long>{41});
  ASSERT_TRUE(m.fit.stiffness);
  EXPECT_NEAR(m.fit.stiffness->value, 400.0, 4.0 * m.fit.stiffness->fit_sigma);
}

TEST(Chain, FreeBeadIsTheTipWithoutAPipetteRegion) {
  Phantom phantom;
  Calibration calibration = phantom_calibration(phantom);
  calibration.pipette = std::nullopt;
  const Measurement m = measure_phantom(phantom, calibration);
  ASSERT_TRUE(m.fit.stiffness);
  EXPECT_NEAR(m.fit.stiffness->value, 400.0, 4.0 * m.fit.stiffness->fit_sigma);
  EXPECT_LT(m.fit.errors(0, 1), 0.0);  // the free bead's error lengthens one and shortens the other
}

TEST(Chain, BeadsFoundByTheProgramAreToldApartByTheirMotion) {
  Phantom phantom;
  phantom.direction = Direction::tangential;
  phantom.bridge_stiffness = 15.0;
  const Measurement given = measure_phantom(phantom);
  Calibration calibration = given.calibration;
  calibration.bead_fixed = calibration.bead_free = std::nullopt;
  const Measurement found = measure_phantom(phantom, calibration);
  EXPECT_LT((found.scene.fixed.centre - given.scene.fixed.centre).norm(), 0.2);
  ASSERT_TRUE(found.fit.stiffness && given.fit.stiffness);
  EXPECT_NEAR(found.fit.stiffness->value, given.fit.stiffness->value, 2.0 * given.fit.stiffness->fit_sigma);
  calibration.bead_fixed = given.calibration.bead_free;
  calibration.bead_free = given.calibration.bead_fixed;
  EXPECT_THROW(measure_phantom(phantom, calibration), BadInput);
}

TEST(Chain, TheLinearRangeEndsWhereTheBridgeSoftens) {
  Phantom phantom;
  phantom.direction = Direction::tangential;
  phantom.bridge_stiffness = 15.0;
  const Measurement straight = measure_phantom(phantom);
  ASSERT_TRUE(straight.fit.loading);
  EXPECT_EQ(straight.fit.loading->line.points, straight.fit.loading->frames);
  phantom.softening = 0.9;
  const Measurement soft = measure_phantom(phantom);
  EXPECT_TRUE(!soft.fit.loading || soft.fit.loading->line.points < soft.fit.loading->frames);
}

TEST(Chain, BeadsThatMoveTogetherHaveNoStiffness) {
  Phantom phantom;
  phantom.bridge_stiffness = 4e6;
  const Measurement m = measure_phantom(phantom);
  EXPECT_FALSE(m.fit.stiffness);
}

struct Case {
  bool held = false, held_by_fit = false, straight = false;
  double half_width = 0.0, pull = 0.0;
};

/// One made-up bridge of the paper's range: its stiffness by finite elements, a test of it with values of the
/// calibration drawn from their stated uncertainties, and what comes back.
Case run_case(std::uint64_t index) {
  const auto draw = [&](std::uint64_t n) { return random_uniform(2021, 16 * index + n); };
  const double d = 1e-6 * (50.0 + 220.0 * draw(0)), gap = 1e-6 * (1.0 + draw(1));
  const micromechanics::BridgeStiffness bridge =
      micromechanics::bridge_stiffness({d, gap, 365e-6, 365e-6}, {50e3, 0.49});
  Phantom phantom;
  phantom.direction = index % 2 ? Direction::tangential : Direction::normal;
  phantom.bridge_stiffness = index % 2 ? bridge.tangential : bridge.normal;
  phantom.seed = index + 1;
  phantom.loading = 15, phantom.unloading = 13;
  phantom.drift = 1.6 * (draw(2) - 0.5);
  phantom.light = 0.2 * (draw(3) - 0.5);
  if (draw(4) < 0.5) phantom.dropped = 5 + static_cast<int>(23.0 * draw(5));
  const Calibration stated = phantom_calibration(phantom);
  phantom.pipette_stiffness += stated.pipette_stiffness_sigma * random_normal(77, index);
  phantom.um_per_pixel *= 1.0 + 0.01 * random_normal(78, index);
  const Measurement m = measure_phantom(phantom, stated);
  Case result;
  if (!m.fit.stiffness) return result;
  const auto& k = *m.fit.stiffness;
  const double truth = phantom.bridge_stiffness;
  const double for_stated = truth * stated.pipette_stiffness / phantom.pipette_stiffness;
  result.held = truth >= k.low && truth <= k.high;
  result.pull = (k.value - for_stated) / k.fit_sigma;
  result.straight = true;
  result.half_width = 0.5 * (k.high - k.low) / k.value;
  return result;
}

TEST(Chain, AStiffnessByFiniteElementsComesBackWithinItsIntervalInNineOfTenCases) {
  std::vector<Case> cases(200);
  for_blocks(cases.size(), 1, [&](std::size_t k, std::size_t) { cases[k] = run_case(k); });
  int held = 0, straight = 0;
  double squares = 0.0;
  std::vector<double> widths;
  for (const Case& c : cases) {
    held += c.held;
    straight += c.straight;
    squares += c.pull * c.pull;
    widths.push_back(c.half_width);
  }
  std::nth_element(widths.begin(), widths.begin() + 100, widths.end());
  const double spread = std::sqrt(squares / straight);
  std::printf(
      "coverage %d of 200, with a linear range %d, median relative half width %.4f, sd of pulls of the fit "
      "%.3f\n",
      held, straight, widths[100], spread);
  EXPECT_GE(held, 180);
  EXPECT_EQ(straight, 200);
  EXPECT_LT(widths[100], 0.12);  // 5 % of the pipette's stiffness alone make 0.093
  EXPECT_NEAR(spread, 1.0, 0.3);
}

}  // namespace
}  // namespace pendular::pipette
