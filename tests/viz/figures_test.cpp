#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "viz/band_plot.h"
#include "viz/matrix_plot.h"
#include "viz/row_plot.h"

namespace pendular {
namespace {

using Pixel = std::array<std::uint8_t, 3>;
using viz::Image;

/// Column of the leftmost pixel of a kind; the width where there is none.
int leftmost(const Image& image, const std::function<bool(const Pixel&)>& is) {
  for (int x = 0; x < image.width; ++x)
    for (int y = 0; y < image.height; ++y)
      if (is(image.pixel(x, y))) return x;
  return image.width;
}

bool reddish(const Pixel& p) {
  return p[0] > p[2] + 60;
}

bool bluish(const Pixel& p) {
  return p[2] > p[0] + 60;
}

TEST(MatrixPlot, PositiveIsRedNegativeIsBlueAndNothingIsNeither) {
  const viz::Display display;
  const auto draw = [&](double left, double right) {
    return viz::draw_matrix(display, {{"row"}, {"first", "second"}, {left, right}, {}, {}, "z", true, 5.0});
  };
  const Image rising = draw(-5.0, 5.0), falling = draw(5.0, -5.0);
  EXPECT_LT(leftmost(rising, bluish), leftmost(rising, reddish));
  EXPECT_LT(leftmost(falling, reddish), leftmost(falling, bluish));
  const Image half = draw(std::numeric_limits<double>::quiet_NaN(), 5.0);
  EXPECT_EQ(leftmost(half, reddish), leftmost(rising, reddish));
}

TEST(MatrixPlot, IsAsHighAsItsRowsNeed) {
  const viz::Display display;
  const auto height = [&](std::size_t rows) {
    return viz::draw_matrix(display,
                            {std::vector<std::string>(rows, "r"), {"c"}, std::vector<double>(rows, 1.0)})
        .height;
  };
  EXPECT_GT(height(40), height(20) + 300);
}

/// Lengths of the bars: pixels of the bars' own colour in each line of the picture.
std::set<int> bar_lengths(const Image& image) {
  std::set<int> lengths;
  for (int y = 0; y < image.height; ++y) {
    int length = 0;
    for (int x = 0; x < image.width; ++x) length += image.pixel(x, y) == Pixel{31, 90, 165};
    if (length > 5) lengths.insert(length);
  }
  return lengths;
}

TEST(RowPlot, BarsAreAsLongAsTheirValues) {
  const viz::Display display;
  const viz::RowPlot plot{{"one", "three", "none"},
                          {},
                          {{"value", {{"", {1.0, 3.0, std::numeric_limits<double>::quiet_NaN()}}}}}};
  const auto lengths = bar_lengths(viz::draw_rows(display, plot));
  ASSERT_FALSE(lengths.empty());
  EXPECT_NEAR(static_cast<double>(*lengths.rbegin()) / *lengths.begin(), 3.0, 0.05);
  for (const int length : lengths)
    EXPECT_TRUE(length < *lengths.begin() + 4 || length > *lengths.rbegin() - 4) << length;
}

/// Pixels of the first band's fill.
long tinted(const Image& image) {
  long count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Pixel p = image.pixel(x, y);
      count += p[0] > 150 && p[0] < 230 && p[2] > p[0] + 15;
    }
  return count;
}

TEST(BandPlot, BandsAreAsWideAsTheirEndsAndInterruptedWhereNothingIsKnown) {
  const viz::Display display;
  const auto draw = [&](double half, double known_to) {
    viz::BandPlot plot{"x", "y", "difference", {"measured", {0, 1, 2, 3, 4}, {0, 3, 5, 7, 10}}, {}, {}};
    viz::Band band{"simulated", {0, 1, 2, 3, 4}, {}, {}, {}};
    for (const double x : band.x) {
      const double middle = x <= known_to ? 5.0 : std::numeric_limits<double>::quiet_NaN();
      band.low.push_back(middle - half), band.middle.push_back(middle), band.high.push_back(middle + half);
    }
    plot.bands = {band};
    return tinted(viz::draw_bands(display, plot, {800, 600}));
  };
  const auto narrow = static_cast<double>(draw(1.0, 4.0));
  EXPECT_GT(narrow, 1000.0);
  EXPECT_NEAR(static_cast<double>(draw(2.0, 4.0)) / narrow, 2.0, 0.25);
  EXPECT_NEAR(static_cast<double>(draw(1.0, 2.0)) / narrow, 0.5, 0.1);
}

}  // namespace
}  // namespace pendular
