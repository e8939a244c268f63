#include "phantom/phantom.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace pendular::segmentation {
namespace {

constexpr double voxel = 5e-6;

/// Clean, empty surroundings: no wall, pistons, blur or noise; 16 bit, edge 50000 grey values, so
/// that one grey value is 2e-5 of the edge.
Sample::Phantom clean() {
  Sample::Phantom settings;
  settings.voxel = voxel;
  settings.blur_voxels = 0.0;
  settings.noise = 0.0;
  settings.wall_thickness = 0.0;
  settings.piston_contrast = 0.0;
  settings.margin = 0.0;
  settings.air_grey = 10000.0 / 65535.0;
  settings.glass_grey = 60000.0 / 65535.0;
  return settings;
}

/// A specimen of `width` voxels across and high, its middle at the origin, which is the middle of a voxel
/// where `width` is odd. Beads and necks in voxels.
struct Scene {
  explicit Scene(double width) {
    packing.specimen = {width * voxel, width * voxel, 0.0, 0.0, -0.5 * width * voxel};
  }
  Scene& bead(const Vec3& centre, double radius) {
    Bead added;
    added.id = static_cast<std::int64_t>(packing.beads.size());
    added.centre = voxel * centre;
    added.diameter = 2.0 * radius * voxel;
    packing.beads.push_back(added);
    return *this;
  }
  Scene& neck(double diameter, BridgeState state = BridgeState::bridge) {
    Bridge added;
    added.i = 0, added.j = 1;
    added.gap = gap(packing.beads[0], packing.beads[1]);
    added.diameter = diameter * voxel;
    added.state = state;
    packing.bridges.push_back(added);
    return *this;
  }
  Packing packing;
};

/// Grey values above air over the air–glass edge, with voxel coordinates from the volume's middle.
struct Field {
  Field(const Packing& packing, const Sample::Phantom& settings, std::uint64_t seed = 1)
      : volume(phantom::make_phantom(packing, settings, seed)) {
    const double full = settings.bits == 8.0 ? 255.0 : 65535.0;
    with_pixels(volume, [&](auto pixels) {
      for (auto grey : pixels)
        values.push_back((static_cast<double>(grey) / full - settings.air_grey) /
                         (settings.glass_grey - settings.air_grey));
    });
  }
  double at(std::size_t x, std::size_t y, std::size_t z) const {
    return values[x + volume.size[0] * (y + volume.size[1] * z)];
  }
  Vec3 place(std::size_t index) const {
    const std::size_t nx = volume.size[0], ny = volume.size[1];
    const Vec3 voxels(static_cast<double>(index % nx), static_cast<double>(index / nx % ny),
                      static_cast<double>(index / nx / ny));
    return (volume.origin + volume.spacing * voxels) / voxel;
  }
  double sum() const {
    double total = 0.0;
    for (double value : values) total += value;
    return total;
  }
  Vec3 centroid() const {
    Vec3 moment = Vec3::Zero();
    for (std::size_t i = 0; i < values.size(); ++i) moment += values[i] * place(i);
    return moment / sum();
  }
  double mean() const { return sum() / static_cast<double>(values.size()); }
  /// Mean of the product of deviations `lag` voxels apart along an axis.
  double covariance(std::size_t axis, std::size_t lag) const {
    const auto [nx, ny, nz] = volume.size;
    const std::size_t step = axis == 0 ? lag : axis == 1 ? lag * nx : lag * nx * ny;
    const double middle = mean();
    double total = 0.0;
    std::size_t count = 0;
    for (std::size_t z = 0; z + (axis == 2 ? lag : 0) < nz; ++z)
      for (std::size_t y = 0; y + (axis == 1 ? lag : 0) < ny; ++y)
        for (std::size_t x = 0; x + (axis == 0 ? lag : 0) < nx; ++x, ++count) {
          const std::size_t i = x + nx * (y + ny * z);
          total += (values[i] - middle) * (values[i + step] - middle);
        }
    return total / static_cast<double>(count);
  }

  Volume volume;
  std::vector<double> values;
};

double ball_volume(double radius) {
  return 4.0 / 3.0 * M_PI * std::pow(radius, 3);
}

/// A ball of radius R convolved with an isotropic Gaussian of sd s, at distance r from its centre: the
/// integral of the Gaussian over the ball in spherical coordinates about the point, done in closed form.
double blurred_ball(double r, double radius, double s) {
  const double root2s = std::sqrt(2.0) * s;
  const double flat = 0.5 * (std::erf((radius - r) / root2s) + std::erf((radius + r) / root2s));
  const double near = std::exp(-std::pow((r - radius) / root2s, 2));
  const double far = std::exp(-std::pow((r + radius) / root2s, 2));
  return flat - s / (r * std::sqrt(2.0 * M_PI)) * (near - far);
}

/// The part of a cylinder of radius a that lies in the half of a centred ball.
double capped(double radius, double a) {
  return 2.0 * M_PI / 3.0 * (std::pow(radius, 3) - std::pow(radius * radius - a * a, 1.5));
}

TEST(Phantom, GreyAboveAirIsTheVolumeOfTheBeads) {
  for (double radius : {8.0, 10.3, 20.0})
    for (double blur : {0.0, 1.0}) {
      auto settings = clean();
      settings.blur_voxels = blur;
      const Field field(Scene(55).bead({0.31, -0.17, 0.44}, radius).packing, settings);
      EXPECT_NEAR(field.sum() / ball_volume(radius), 1.0, 1e-4) << "radius " << radius << ", blur " << blur;
    }
}

TEST(Phantom, ProfileOfABeadIsThatOfABlurredBall) {
  for (double radius : {8.0, 20.0}) {
    auto settings = clean();
    settings.blur_voxels = 1.0;
    const Vec3 centre(0.31, -0.17, 0.44);
    const Field field(Scene(55).bead(centre, radius).packing, settings);
    const double spread = std::sqrt(1.0 + 1.0 / 12.0);  // the average over a voxel adds its variance
    for (std::size_t i = 0; i < field.values.size(); ++i) {
      const double r = (field.place(i) - centre).norm();
      ASSERT_NEAR(field.values[i], blurred_ball(r, radius, spread), 1e-4)
          << "radius " << radius << " at " << r;
    }
  }
}

TEST(Phantom, NeckIsACylinderLessBothBalls) {
  struct Case {
    double radius_a, radius_b, gap, diameter;
  };
  for (const Case& c :
       {Case{20, 20, 0.4, 15}, Case{20, 20, 0.0, 8}, Case{20, 16, 1.5, 15}, Case{12, 9, 0.2, 16}}) {
    const double length = c.radius_a + c.radius_b + c.gap;
    const Vec3 axis = Vec3(0.48, -0.36, 0.8);
    Scene scene(95);
    scene.bead(-c.radius_a * axis, c.radius_a).bead((length - c.radius_a) * axis, c.radius_b);
    auto settings = clean();
    settings.polymer_contrast = 0.5;
    const double without = Field(scene.packing, settings).sum();
    const Field with(scene.neck(c.diameter).packing, settings);
    const double a = 0.5 * c.diameter;
    const double volume = M_PI * a * a * length - capped(c.radius_a, a) - capped(c.radius_b, a);
    EXPECT_NEAR((with.sum() - without) / (0.5 * volume), 1.0, 0.01)
        << c.radius_a << " " << c.radius_b << " " << c.gap << " " << c.diameter;
  }
}

TEST(Phantom, NeckIsBlurredAsABodyOfItsOwn) {
  const double radius_a = 14.0, radius_b = 12.0, spacing = 0.3, a = 6.0;
  const double length = radius_a + radius_b + spacing;
  const Vec3 axis(0.48, -0.36, 0.8);
  const Vec3 centre_a = -radius_a * axis, centre_b = (length - radius_a) * axis;
  auto settings = clean();
  settings.blur_voxels = 1.0;
  settings.polymer_contrast = 1.0;
  Scene scene(65);
  const Field without(scene.bead(centre_a, radius_a).bead(centre_b, radius_b).packing, settings);
  const Field with(scene.neck(2.0 * a).packing, settings);

  // The neck as points of a fine lattice, each spread by the Gaussian.
  constexpr double fine = 0.125;
  std::vector<Vec3> points;
  for (double z = -10; z < 10; z += fine)
    for (double y = -10; y < 10; y += fine)
      for (double x = -10; x < 10; x += fine) {
        const Vec3 point(x, y, z);
        const double along = (point - centre_a).dot(axis);
        if ((point - centre_a - along * axis).norm() < a && (point - centre_a).norm() > radius_a &&
            (point - centre_b).norm() > radius_b && along > 0.0 && along < length)
          points.push_back(point);
      }
  const double variance = 1.0 + 1.0 / 12.0;
  for (std::size_t i = 0; i < with.values.size(); ++i) {
    const Vec3 place = with.place(i);
    if (place.norm() > 9.0 || i % 7 != 0) continue;
    double expected = 0.0;
    for (const Vec3& point : points) expected += std::exp(-0.5 * (point - place).squaredNorm() / variance);
    expected *= std::pow(fine / std::sqrt(2.0 * M_PI * variance), 3);
    ASSERT_NEAR(with.values[i] - without.values[i], expected, 2e-3) << place.transpose();
  }
}

TEST(Phantom, OnlyBridgesAndCandidatesHoldPolymer) {
  const auto grey = [](BridgeState state) {
    Scene scene(59);
    scene.bead({-10.2, 0, 0}, 10).bead({10.2, 0, 0}, 10).neck(8, state);
    return Field(scene.packing, clean()).sum();
  };
  EXPECT_EQ(grey(BridgeState::bridge), grey(BridgeState::candidate));
  EXPECT_EQ(grey(BridgeState::none), grey(BridgeState::undetermined));
  EXPECT_GT(grey(BridgeState::bridge), grey(BridgeState::none) + 1.0);
}

TEST(Phantom, ShiftOfABeadShiftsItsCentroid) {
  auto settings = clean();
  settings.blur_voxels = 1.0;
  const Vec3 still = Field(Scene(45).bead({0, 0, 0}, 12).packing, settings).centroid();
  EXPECT_LT(still.norm(), 0.001);
  for (double shift : {0.05, 0.25, 0.5, 0.83}) {
    const Vec3 moved(shift, -0.5 * shift, 0.7 * shift);
    const Vec3 found = Field(Scene(45).bead(moved, 12).packing, settings).centroid() - still;
    EXPECT_LT((found - moved).cwiseAbs().maxCoeff(), 0.005) << shift;
  }
}

TEST(Phantom, WhiteNoiseIsGaussianAndUncorrelated) {
  auto settings = clean();
  settings.noise = 0.04;
  const Field field(Scene(64).packing, settings);
  const double variance = field.covariance(0, 0);
  EXPECT_NEAR(field.mean(), 0.0, 1e-3);
  EXPECT_NEAR(std::sqrt(variance), 0.04, 4e-4);
  double fourth = 0.0;
  for (double value : field.values) fourth += std::pow(value, 4);
  EXPECT_NEAR(fourth / static_cast<double>(field.values.size()) / (variance * variance), 3.0, 0.05);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(field.covariance(axis, 1) / variance, 0.0, 0.01);
}

TEST(Phantom, CorrelatedNoiseHasTheSdAndTheReachAskedFor) {
  for (double reach : {1.0, 2.0}) {
    auto settings = clean();
    settings.correlated_noise = 0.04;
    settings.correlation_voxels = reach;
    const Field field(Scene(120).packing, settings);
    const double variance = field.covariance(0, 0);
    EXPECT_NEAR(std::sqrt(variance), 0.04, 1.2e-3) << reach;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t lag : {std::size_t{1}, std::size_t{3}}) {
        const auto t = static_cast<double>(lag);
        EXPECT_NEAR(field.covariance(axis, lag) / variance, std::exp(-t * t / (4.0 * reach * reach)), 0.03)
            << "reach " << reach << ", axis " << axis << ", lag " << lag;
      }
  }
}

TEST(Phantom, WallAndPistonsStandWhereTheSpecimenSaysSo) {
  auto settings = clean();
  settings.wall_thickness = 4.0 * voxel;
  settings.margin = 6.0 * voxel;
  settings.wall_contrast = 0.5;
  settings.piston_contrast = 0.8;
  Packing packing;
  packing.specimen = {40.0 * voxel, 30.5 * voxel, 0.0, 0.0, 0.0};
  const Field field(packing, settings);
  ASSERT_EQ(field.volume.size, (std::array<std::size_t, 3>{60, 60, 43}));
  double wall = 0.0, pistons = 0.0;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const Vec3 place = field.place(i);
    const double from_axis = std::hypot(place.x(), place.y());
    const bool in_height = place.z() > 0.9 && place.z() < 29.6, beyond = place.z() < -0.9 || place.z() > 31.4;
    double expected = NAN;  // not said where a surface crosses the voxel
    if (from_axis > 25.0) expected = 0.0;
    if (from_axis > 21.0 && from_axis < 23.0) expected = 0.5;
    if (from_axis < 19.0 && in_height) expected = 0.0;
    if (from_axis < 19.0 && beyond) expected = 0.8;
    if (!std::isnan(expected)) {
      ASSERT_NEAR(field.values[i], expected, 1e-4) << place.transpose();
    }
    (from_axis > 20.0 ? wall : pistons) += field.values[i];
  }
  const double bore = M_PI * 400.0, tube = M_PI * (576.0 - 400.0);
  EXPECT_NEAR((wall + pistons) / (0.5 * tube * 43.0 + 0.8 * bore * 12.5), 1.0, 1e-3);
}

TEST(Phantom, BeamHardeningDimsTheAxis) {
  auto settings = clean();
  settings.piston_contrast = 1.0;
  settings.margin = 10.0 * voxel;
  settings.beam_hardening = 0.3;
  Packing packing;
  packing.specimen = {81.0 * voxel, 21.0 * voxel, 0.0, 0.0, 0.0};
  const Field field(packing, settings);
  for (std::size_t x = 11; x < 90; ++x) {  // across the lower piston, through the axis
    const double share = (static_cast<double>(x) - 50.0) / 40.5;
    EXPECT_NEAR(field.at(x, 50, 2), 1.0 - 0.3 * (1.0 - share * share), 1e-3);
  }
  EXPECT_NEAR(field.at(50, 50, 20), 0.0, 1e-4);
}

TEST(Phantom, RingsAreConcentricAndTheSameInEverySlice) {
  auto settings = clean();
  settings.rings = 0.05;
  Packing packing;
  packing.specimen = {1201.0 * voxel, 3.0 * voxel, 0.0, 0.0, 0.0};
  const Field field(packing, settings);
  double square = 0.0;
  for (std::size_t r = 0; r <= 600; ++r) {
    const double value = field.at(600 + r, 600, 0);
    square += value * value;
    ASSERT_EQ(value, field.at(600 - r, 600, 0));
    ASSERT_EQ(value, field.at(600, 600 + r, 2));
  }
  EXPECT_NEAR(std::sqrt(square / 601.0), 0.05, 0.005);
}

TEST(Phantom, EightBitsAreClippedToTheirScale) {
  auto settings = clean();
  settings.bits = 8;
  settings.air_grey = 0.0;
  settings.glass_grey = 1.0;
  settings.noise = 0.2;
  const Volume volume = phantom::make_phantom(Scene(41).bead({0, 0, 0}, 15).packing, settings, 1);
  ASSERT_EQ(pixel_type(volume), "uint8");
  std::array<std::size_t, 256> histogram{};
  for (std::uint8_t grey : std::get<std::vector<std::uint8_t>>(volume.pixels)) ++histogram[grey];
  const double ball = ball_volume(15.0), rest = std::pow(41.0, 3) - ball;
  EXPECT_NEAR(static_cast<double>(histogram[0]) / rest, 0.5, 0.05);
  EXPECT_NEAR(static_cast<double>(histogram[255]) / ball, 0.5, 0.05);
}

TEST(Phantom, IsTheSameForAnyNumberOfThreadsAndDiffersBySeed) {
  Scene scene(50);
  scene.bead({-12.2, 0, 3}, 12).bead({12.3, 2, -3}, 12).neck(9);
  auto settings = clean();
  settings.blur_voxels = 1.0;
  settings.noise = settings.correlated_noise = 0.1;
  settings.rings = 0.02;
  settings.margin = 5.0 * voxel;
  set_threads(1);
  const Volume one = phantom::make_phantom(scene.packing, settings, 7);
  set_threads(2);
  const Volume two = phantom::make_phantom(scene.packing, settings, 7);
  set_threads(0);
  EXPECT_TRUE(one.pixels == two.pixels);
  EXPECT_FALSE(one.pixels == phantom::make_phantom(scene.packing, settings, 8).pixels);
}

TEST(Phantom, VolumesBeyondMemoryAreRefused) {
  auto settings = clean();
  settings.voxel = 1e-9;
  const Packing small = Scene(800).packing;  // 4 mm
  EXPECT_THROW(phantom::make_phantom(small, settings, 1), ComputationFailed);
  settings.voxel = 1e-15;
  EXPECT_THROW(phantom::make_phantom(small, settings, 1), ComputationFailed);
}

TEST(Phantom, ImpossibleBodiesAreRefused) {
  const auto pair = [] { return Scene(49).bead({-10, 0, 0}, 10).bead({11, 0, 0}, 10); };
  EXPECT_THROW(phantom::make_phantom(pair().neck(20).packing, clean(), 1), BadInput);
  EXPECT_THROW(phantom::make_phantom(pair().neck(-3).packing, clean(), 1), BadInput);
  EXPECT_THROW(phantom::make_phantom(pair().neck(NAN).packing, clean(), 1), BadInput);
  EXPECT_THROW(phantom::make_phantom(Scene(9).bead({0, 0, 0}, 0).packing, clean(), 1), BadInput);
  EXPECT_THROW(phantom::make_phantom(Scene(9).bead({NAN, 0, 0}, 3).packing, clean(), 1), BadInput);
  EXPECT_THROW(phantom::make_phantom(Packing(), clean(), 1), BadInput);
}

TEST(NeckDiameters, AreDrawnFromTheTruncatedNormal) {
  Sample sample;
  sample.bridges.diameter = 70e-6;
  sample.bridges.diameter_sd = 20e-6;
  Packing packing = Scene(99).bead({-20, 0, 0}, 20).bead({20, 0, 0}, 20).packing;
  packing.bridges.resize(20000);
  for (auto& bridge : packing.bridges) bridge.j = 1;
  phantom::draw_neck_diameters(packing, sample, 3);
  double sum = 0.0;
  for (const auto& bridge : packing.bridges) {
    ASSERT_EQ(bridge.state, BridgeState::bridge);
    ASSERT_GE(bridge.diameter, 40e-6);
    ASSERT_LE(bridge.diameter, 180e-6);
    sum += bridge.diameter;
  }
  // Mean of N(μ, σ) truncated at α = −1.5 and β = 5.5 standard deviations: μ + σ (φ(α) − φ(β))/(Φ(β) − Φ(α)).
  const double mean = 70e-6 + 20e-6 * 0.129518 / 0.933193;
  EXPECT_NEAR(sum / 20000.0, mean, 0.5e-6);
}

TEST(NeckDiameters, KeepWhatIsKnown) {
  Packing packing = Scene(99).bead({-20, 0, 0}, 20).bead({20, 0, 0}, 20).packing;
  packing.bridges.resize(3);
  for (auto& bridge : packing.bridges) bridge.j = 1;
  packing.bridges[0].diameter = 33e-6;
  packing.bridges[1].state = BridgeState::none;
  packing.bridges[2].state = BridgeState::undetermined;
  phantom::draw_neck_diameters(packing, Sample(), 3);
  EXPECT_EQ(packing.bridges[0].diameter, 33e-6);
  EXPECT_EQ(packing.bridges[0].state, BridgeState::bridge);
  EXPECT_EQ(packing.bridges[1].state, BridgeState::none);
  EXPECT_EQ(packing.bridges[1].diameter, 0.0);
  EXPECT_EQ(packing.bridges[2].state, BridgeState::undetermined);
}

}  // namespace
}  // namespace pendular::segmentation
