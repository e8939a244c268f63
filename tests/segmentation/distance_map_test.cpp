#include "segmentation/search/distance_map.h"

#include <gtest/gtest.h>
#include <itkImage.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <cmath>
#include <limits>

#include "base/random.h"
#include "segmentation/search/seeds.h"

namespace pendular::segmentation {
namespace {

/// Balls at random places, so that there are thick parts, thin ones and holes.
Grid<std::uint8_t> random_mask(const std::array<std::size_t, 3>& size, int balls, double radius,
                               std::uint64_t seed) {
  Grid<std::uint8_t> mask{size, 1.0, std::vector<std::uint8_t>(size[0] * size[1] * size[2])};
  for (int b = 0; b < balls; ++b) {
    const auto draw = [&](std::uint64_t axis) {
      return random_uniform(seed, 3 * static_cast<std::uint64_t>(b) + axis) * static_cast<double>(size[axis]);
    };
    const Vec3 centre(draw(0), draw(1), draw(2));
    for (std::size_t k = 0; k < size[2]; ++k)
      for (std::size_t j = 0; j < size[1]; ++j)
        for (std::size_t i = 0; i < size[0]; ++i)
          if ((mask.at(i, j, k) - centre).norm() < radius) mask.values[mask.index(i, j, k)] = 1;
  }
  return mask;
}

/// By the definition: every node against every other.
std::vector<float> by_definition(const Grid<std::uint8_t>& mask) {
  std::vector<Vec3> surface;
  const auto each = [&](const auto& visit) {
    for (std::size_t k = 0; k < mask.size[2]; ++k)
      for (std::size_t j = 0; j < mask.size[1]; ++j)
        for (std::size_t i = 0; i < mask.size[0]; ++i) visit(i, j, k);
  };
  const auto is_surface = [&](std::size_t i, std::size_t j, std::size_t k) {
    for (std::size_t c = k ? k - 1 : 0; c < std::min(mask.size[2], k + 2); ++c)
      for (std::size_t b = j ? j - 1 : 0; b < std::min(mask.size[1], j + 2); ++b)
        for (std::size_t a = i ? i - 1 : 0; a < std::min(mask.size[0], i + 2); ++a)
          if (!mask.values[mask.index(a, b, c)]) return true;
    return false;
  };
  each([&](auto i, auto j, auto k) {
    if (mask.values[mask.index(i, j, k)] && is_surface(i, j, k)) surface.push_back(mask.at(i, j, k));
  });
  std::vector<float> distances;
  each([&](auto i, auto j, auto k) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& node : surface) least = std::min(least, (node - mask.at(i, j, k)).squaredNorm());
    distances.push_back(!mask.values[mask.index(i, j, k)] ? 0.0F
                        : std::isinf(least)               ? std::numeric_limits<float>::max()
                                                          : static_cast<float>(std::sqrt(least)) + 0.5F);
  });
  return distances;
}

TEST(DistanceMap, IsExact) {
  const std::array<std::size_t, 3> sizes[] = {{17, 9, 12}, {33, 5, 7}, {3, 30, 4}, {16, 16, 16}, {1, 1, 20}};
  for (const auto& size : sizes)
    for (const int balls : {1, 3, 12}) {
      const auto mask = random_mask(size, balls, 4.5, 7);
      EXPECT_EQ(distance_inside(mask).values, by_definition(mask)) << size[0] << " " << balls;
    }
}

/// Bodies so large that lines are looked along by envelopes, beside small ones.
TEST(DistanceMap, IsExactInLargeBodies) {
  for (const std::array<std::size_t, 3>& size :
       {std::array<std::size_t, 3>{3, 700, 5}, {5, 3, 700}, {2, 400, 300}, {21, 400, 2}}) {
    Grid<std::uint8_t> mask{size, 1.0, std::vector<std::uint8_t>(size[0] * size[1] * size[2], 1)};
    for (std::uint64_t hole = 0; hole < 12; ++hole)  // one half has none
      mask.values[random_bits(11, hole) % (mask.values.size() / 2)] = 0;
    EXPECT_EQ(distance_inside(mask).values, by_definition(mask)) << size[0] << " " << size[1];
  }
}

TEST(DistanceMap, OfAMaskWithoutASurfaceIsEndless) {
  const Grid<std::uint8_t> full{{20, 5, 4}, 1.0, std::vector<std::uint8_t>(400, 1)},
      none{{20, 5, 4}, 1.0, std::vector<std::uint8_t>(400, 0)};
  for (const float one : distance_inside(full).values) EXPECT_EQ(one, std::numeric_limits<float>::max());
  for (const float one : distance_inside(none).values) EXPECT_EQ(one, 0.0F);
}

TEST(DistanceMap, OfALongLineEndsWhereItSays) {
  constexpr std::size_t kFarthest = 10000;
  constexpr std::size_t kLengths[] = {60000, 11000, 11000};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t length = kLengths[axis];
    Grid<std::uint8_t> line{{1, 1, 1}, 1.0, std::vector<std::uint8_t>(length, 1)};
    line.size[axis] = length;
    line.values[0] = 0;  // so that node 1 is the surface
    const Grid<float> found = distance_inside(line);
    for (const std::size_t n : {std::size_t{1}, std::size_t{2}, kFarthest, kFarthest + 1})
      EXPECT_EQ(found.values[n], static_cast<float>(n) - 0.5F) << axis;
    for (const std::size_t n : {kFarthest + 2, length - 1})
      EXPECT_EQ(found.values[n], std::numeric_limits<float>::max()) << axis;
  }
}

// A blank half of a scan: most of it is farther from any surface than is looked at.
TEST(Seeds, NoneIsLargerThanTheBodyThatItIsIn) {
  Grid<std::uint8_t> blank{{8, 8, 700}, 1.0, std::vector<std::uint8_t>(8 * 8 * 700, 1)};
  EXPECT_TRUE(find_seeds(blank, 3.0).empty());
  for (std::size_t k = 400; k < 700; ++k)  // and a body of nine slices beside it
    std::fill_n(blank.values.begin() + static_cast<std::ptrdiff_t>(blank.index(0, 0, k)), 64, k / 9 == 60);
  const auto seeds = find_seeds(blank, 3.0);
  ASSERT_EQ(seeds.size(), 1u);
  EXPECT_DOUBLE_EQ(seeds.front().radius, 4.5);
  EXPECT_DOUBLE_EQ(seeds.front().centre.z(), 544.0);
}

// Another program's map.
TEST(DistanceMap, IsThatOfITK) {
  auto mask = random_mask({70, 61, 50}, 40, 11.0, 3);
  using Mask = itk::Image<std::uint8_t, 3>;
  auto image = Mask::New();
  image->SetRegions(Mask::SizeType{{mask.size[0], mask.size[1], mask.size[2]}});
  image->Allocate();
  std::copy(mask.values.begin(), mask.values.end(), image->GetBufferPointer());
  auto filter = itk::SignedMaurerDistanceMapImageFilter<Mask, itk::Image<float, 3>>::New();
  filter->SetInput(image);
  filter->SetSquaredDistance(false);
  filter->SetInsideIsPositive(true);
  filter->Update();
  const float* const expected = filter->GetOutput()->GetBufferPointer();
  const Grid<float> found = distance_inside(mask);
  for (std::size_t n = 0; n < mask.values.size(); ++n)
    EXPECT_EQ(found.values[n], mask.values[n] ? std::fabs(expected[n]) + 0.5F : 0.0F) << n;
}

}  // namespace
}  // namespace pendular::segmentation
