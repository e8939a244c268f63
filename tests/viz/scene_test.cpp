#include "viz/scene.h"

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "places.h"
#include "planted_run.h"
#include "scratch.h"
#include "viz/ticks.h"

namespace pendular {
namespace {

using viz::Image;
constexpr viz::PictureSize kSize{800, 600};

double luminance(const Image& image, int x, int y) {
  const auto [r, g, b] = image.pixel(x, y);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

bool is_red(const Image& image, int x, int y) {
  const auto [r, g, b] = image.pixel(x, y);
  return r > 60 && r > 1.8 * g && r > 1.8 * b;
}

/// Where the specimen is drawn: left of the colour bar and below the title.
struct Field {
  int left = 0, right = static_cast<int>(0.77 * kSize.width);
  int top = static_cast<int>(0.14 * kSize.height), bottom = kSize.height;
};

/// Centre, and angle to the vertical of the main direction, of the red pixels; rad, positive: from upper left
/// to lower right.
struct RedLine {
  double x = 0.0, y = 0.0, angle = 0.0;
  int count = 0;
};
RedLine red_line(const Image& image) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  const Field field;
  for (int y = field.top; y < field.bottom; ++y)
    for (int x = field.left; x < field.right; ++x)
      if (is_red(image, x, y))
        n += 1, sx += x, sy += y, sxx += 1.0 * x * x, sxy += 1.0 * x * y, syy += 1.0 * y * y;
  if (n == 0) return {};
  const double cxx = sxx / n - sx * sx / n / n, cxy = sxy / n - sx * sy / n / n,
               cyy = syy / n - sy * sy / n / n;
  return {sx / n, sy / n, 0.5 * std::atan2(2.0 * cxy, cyy - cxx), static_cast<int>(n)};
}

/// CIELAB lightness of an sRGB colour (D65).
double lightness(const std::array<std::uint8_t, 3>& rgb) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  const double y =
      0.2126 * linear(rgb[0] / 255.0) + 0.7152 * linear(rgb[1] / 255.0) + 0.0722 * linear(rgb[2] / 255.0);
  return y > 216.0 / 24389.0 ? 116.0 * std::cbrt(y) - 16.0 : y * 24389.0 / 27.0;
}

class Scenes : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    display_ = std::make_unique<viz::Display>();
    painter_ = std::make_unique<viz::ScenePainter>(*display_, kSize);
    const fs::path folder = fs::temp_directory_path() / ("pendular.scene." + std::to_string(::getpid()));
    test::write_planted_run(folder, planted_);
    run_ = read_run_folder(folder);
    first_ = viz::read_frame(run_.frames.front());
    last_ = viz::read_frame(run_.frames.back());
    stage_ = viz::make_stage(first_, last_, run_.result);
    fs::remove_all(folder);
  }
  static void TearDownTestSuite() {
    painter_.reset();
    display_.reset();
  }

  static Image draw(const viz::View& view, const viz::Frame& frame) {
    return painter_->draw(view, frame, stage_, viz::colour_range(view, frame, stage_));
  }

  static inline std::unique_ptr<viz::Display> display_;
  static inline std::unique_ptr<viz::ScenePainter> painter_;
  static inline test::PlantedRun planted_;
  static inline RunFolder run_;
  static inline viz::Frame first_, last_;
  static inline viz::Stage stage_;
};

TEST_F(Scenes, EveryViewShowsSomethingAndCutsNothingOff) {
  for (const viz::View& view : viz::views()) {
    const Image image = draw(view, last_);
    ASSERT_EQ(image.width, kSize.width);
    ASSERT_EQ(image.height, kSize.height);
    int inked = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const bool ink = luminance(image, x, y) < 250.0;
        inked += ink;
        const bool edge = x < 3 || y < 3 || x >= image.width - 3 || y >= image.height - 3;
        ASSERT_FALSE(edge && ink) << view.name << " at " << x << ", " << y;
      }
    EXPECT_GT(inked, image.width * image.height / 10) << view.name;
  }
}

TEST_F(Scenes, TheBandRunsAtItsPlantedAngleFromUpperLeftToLowerRight) {
  for (const char* name : {"shear_strain", "damage", "broken_bonds"}) {
    const RedLine line = red_line(draw(viz::view_named(name), last_));
    ASSERT_GT(line.count, 2000) << name;
    EXPECT_NEAR(line.angle, planted_.band_angle, 0.10) << name;
  }
}

TEST_F(Scenes, TheBandIsRedAlongItsLineAndPaleBesideIt) {
  const Image image = draw(viz::view_named("shear_strain"), last_);
  const RedLine line = red_line(image);
  const double along_x = std::sin(planted_.band_angle), along_y = std::cos(planted_.band_angle);
  const auto share_of_red = [&](double offset) {
    int red = 0, all = 0;
    for (int t = -100; t <= 100; ++t) {
      const int x = static_cast<int>(line.x + t * along_x + offset * along_y),
                y = static_cast<int>(line.y + t * along_y - offset * along_x);
      red += is_red(image, x, y);
      ++all;
    }
    return static_cast<double>(red) / all;
  };
  EXPECT_GT(share_of_red(0.0), 0.7);
  EXPECT_LT(share_of_red(90.0), 0.02);
  EXPECT_LT(share_of_red(-90.0), 0.02);
}

TEST_F(Scenes, NothingIsRedBeforeTheBandFormed) {
  viz::View view = viz::view_named("damage");
  const Image image = painter_->draw(view, first_, stage_, {0.0, 1.0});
  EXPECT_EQ(red_line(image).count, 0);
}

TEST_F(Scenes, TheCutTakesAwayTheHalfTowardsTheCamera) {
  viz::Frame frame = first_;
  const Vec3 camera = Vec3(std::sin(planted_.band_azimuth), -std::cos(planted_.band_azimuth), 0.0);
  for (std::size_t i = 0; i < frame.damage.size(); ++i)
    frame.damage[i] = frame.position[i].dot(camera) > 0.0 ? 1.0 : 0.0;
  viz::View half = viz::view_named("damage"), whole = half;
  whole.half = false;
  EXPECT_EQ(red_line(painter_->draw(half, frame, stage_, {0.0, 1.0})).count, 0);
  EXPECT_GT(red_line(painter_->draw(whole, frame, stage_, {0.0, 1.0})).count, 40000);
}

TEST_F(Scenes, HoldsNothingOfThePicturesBefore) {
  for (const char* name : {"force_chains", "damage", "displacement", "broken_bonds"}) {
    const viz::View& view = viz::view_named(name);
    const Image image = draw(view, last_);
    viz::ScenePainter fresh(*display_, kSize);
    EXPECT_EQ(image.rgb, fresh.draw(view, last_, stage_, viz::colour_range(view, last_, stage_)).rgb) << name;
  }
}

TEST_F(Scenes, LooksLikeTheKeptPicture) {
  const Image image = draw(viz::view_named("shear_strain"), last_);
  vtkNew<vtkPNGReader> reader;
  const fs::path kept = fs::path(pendular::test::source_folder()) / "tests/viz/shear_strain_16x16.png";
  reader->SetFileName(kept.c_str());
  reader->Update();
  ASSERT_EQ(reader->GetOutput()->GetNumberOfPoints(), 256);
  double total = 0.0;
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 16; ++column) {
      double mean = 0.0;
      const int w = kSize.width / 16, h = kSize.height / 16;
      for (int y = row * h; y < (row + 1) * h; ++y)
        for (int x = column * w; x < (column + 1) * w; ++x) mean += luminance(image, x, y) / (w * h);
      const double difference =
          std::abs(mean - reader->GetOutput()->GetScalarComponentAsDouble(column, 15 - row, 0, 0));
      EXPECT_LT(difference, 40.0) << row << ", " << column;
      total += difference;
    }
  EXPECT_LT(total / 256.0, 6.0);
}

TEST_F(Scenes, EqualStepsOfTheColourBarAreEqualStepsOfLightness) {
  for (const char* name : {"displacement", "shear_strain"}) {
    const Image image = draw(viz::view_named(name), last_);
    const int x = static_cast<int>(0.86 * kSize.width), top = static_cast<int>(0.25 * kSize.height),
              bottom = static_cast<int>(0.75 * kSize.height);
    const double high = lightness(image.pixel(x, top)), low = lightness(image.pixel(x, bottom));
    EXPECT_GT(std::abs(high - low), 45.0);
    for (int y = top; y <= bottom; y += 5) {
      const double even = high + (low - high) * (y - top) / (bottom - top);
      EXPECT_NEAR(lightness(image.pixel(x, y)), even, 3.0) << name << " at " << y;
    }
  }
}

TEST_F(Scenes, ColourRangeIgnoresOutliers) {
  viz::Frame frame = last_;
  const auto before = viz::colour_range(viz::view_named("shear_strain"), frame, stage_);
  for (std::size_t i = 0; i < 10; ++i) frame.shear_strain[i * 17] = i % 2 ? 1e6 : std::nan("");
  const auto after = viz::colour_range(viz::view_named("shear_strain"), frame, stage_);
  EXPECT_NEAR(after.high, before.high, 0.1 * before.high);
  EXPECT_NEAR(after.low, before.low, 0.1 * before.high);
}

TEST_F(Scenes, AFrameWithoutBandOrBreaksIsDrawnToo) {
  const viz::Stage stage = viz::make_stage(first_, first_, {});
  for (const viz::View& view : viz::views())
    EXPECT_NO_THROW(painter_->draw(view, first_, stage, viz::colour_range(view, first_, stage))) << view.name;
}

TEST_F(Scenes, UnknownViewNamesTheKnownOnes) {
  try {
    viz::view_named("strain");
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("shear_strain"), std::string::npos);
  }
}

TEST(Ticks, AreRoundAndInside) {
  const auto check = [](double low, double high, const std::vector<std::string>& expected) {
    EXPECT_EQ(viz::round_ticks(low, high, 5).labels, expected);
  };
  check(0.0, 8.0, {"0", "2", "4", "6", "8"});
  check(0.011, 0.62, {"0.2", "0.4", "0.6"});
  check(-1.0, 1.0, {"-1.0", "-0.5", "0.0", "0.5", "1.0"});
  check(0.0, 4.1e-3, {"0.000", "0.001", "0.002", "0.003", "0.004"});
  check(3.0, 430.0, {"100", "200", "300", "400"});
}

}  // namespace
}  // namespace pendular
