#include "segmentation/bridges/neck_injection.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "segmentation/fit/rings.h"

namespace pendular::segmentation {
namespace {

constexpr double kShares[] = {0.12, 0.16, 0.2, 0.25, 0.3, 0.36, 0.44, 0.54};

/// A part of the picture with a pair in it, balls 0 and 1, and what is around them.
struct Part {
  Volume volume;
  std::vector<GreyBall> balls;
  std::vector<int> others;
  std::optional<Container> container;
};

Part part_about(const Volume& volume, std::span<const GreyBall> balls, const BallPair& pair,
                std::span<const int> near, const std::optional<Container>& container, const Rings* rings) {
  const Vec3 middle = 0.5 * (balls[pair.i].centre + balls[pair.j].centre);
  std::array<std::size_t, 3> first{}, size{};
  for (int axis = 0; axis < 3; ++axis) {
    const double last = static_cast<double>(volume.size[axis]) - 1.0;
    const auto low =
        static_cast<std::size_t>(std::clamp(std::floor(middle[axis] - 1.2 * pair.radius - 6.0), 0.0, last));
    const auto high =
        static_cast<std::size_t>(std::clamp(std::ceil(middle[axis] + 1.2 * pair.radius + 6.0), 0.0, last));
    first[axis] = low, size[axis] = high - low + 1;
  }
  const Vec3 shift(static_cast<double>(first[0]), static_cast<double>(first[1]),
                   static_cast<double>(first[2]));
  Part part{{size, volume.spacing, Vec3::Zero(), {}}, {balls[pair.i], balls[pair.j]}, {}, container};
  for (const int other : near) {
    part.others.push_back(static_cast<int>(part.balls.size()));
    part.balls.push_back(balls[other]);
  }
  for (auto& ball : part.balls) ball.centre -= shift;
  if (part.container) {
    part.container->axis_x -= shift.x(), part.container->axis_y -= shift.y();
    for (auto* end : {&part.container->bottom, &part.container->top})
      if (*end) **end -= shift.z();
  }
  std::vector<float> pixels;
  with_pixels(volume, [&](auto all) {
    for (std::size_t k = 0; k < size[2]; ++k)
      for (std::size_t j = 0; j < size[1]; ++j)
        for (std::size_t i = 0; i < size[0]; ++i)
          pixels.push_back(
              static_cast<float>(grey_at(all, volume, rings, static_cast<long>(first[0] + i),
                                         static_cast<long>(first[1] + j), static_cast<long>(first[2] + k))));
  });
  part.volume.pixels = std::move(pixels);
  return part;
}

void inject(Part& part, double radius, double contrast, double blur) {
  const phantom::Sharpness sharpness(std::sqrt(std::max(0.05, blur * blur - 1.0 / 12.0)));
  const GreyBall &a = part.balls[0], &b = part.balls[1];
  const phantom::NeckImage neck({{a.centre, a.radius}, {b.centre, b.radius}, radius}, sharpness);
  auto& pixels = std::get<std::vector<float>>(part.volume.pixels);
  const auto [nx, ny, nz] = part.volume.size;
  std::vector<float> slice(nx * ny);
  const auto grey = static_cast<float>(contrast * 0.5 * (a.contrast + b.contrast));
  for (std::size_t z = 0; z < nz; ++z) {
    if (!neck.touches(static_cast<int>(z))) continue;
    std::fill(slice.begin(), slice.end(), 0.0F);
    neck.add_to({slice, static_cast<int>(nx), static_cast<int>(ny), static_cast<int>(z)});
    for (std::size_t n = 0; n < slice.size(); ++n) pixels[z * slice.size() + n] += grey * slice[n];
  }
}

}  // namespace

std::vector<NeckRecovery> recover_injected(const Volume& volume, std::span<const GreyBall> balls,
                                           std::span<const BallPair> hosts,
                                           std::span<const std::vector<int>> near,
                                           const std::optional<Container>& container,
                                           const ImageKnowledge& knowledge, const NeckPopulation& population,
                                           double threshold) {
  const NeckTemplates templates(hosts, knowledge.blur);
  ImageKnowledge in_part = knowledge;
  in_part.rings = nullptr;  // taken away where the part is cut out
  constexpr std::size_t sizes = std::size(kShares);
  std::vector<std::optional<NeckVerdict>> verdicts(hosts.size());
  for_blocks(hosts.size(), 1, [&](std::size_t n, std::size_t) {
    Part part = part_about(volume, balls, hosts[n], near[n], container, knowledge.rings);
    inject(part, kShares[n % sizes] * hosts[n].radius, population.contrast, knowledge.blur);
    const BallPair pair{0, 1, hosts[n].gap, hosts[n].radius};
    const auto evidence =
        neck_evidence(part.volume, part.balls, pair, part.others, part.container, in_part, templates);
    if (evidence) verdicts[n] = neck_verdict(*evidence, pair.radius, population);
  });
  std::vector<NeckRecovery> points(sizes);
  std::vector<double> radii(sizes, 0.0), found(sizes, 0.0);
  for (std::size_t n = 0; n < hosts.size(); ++n) {
    if (!verdicts[n]) continue;
    const std::size_t size = n % sizes;
    NeckRecovery& point = points[size];
    const double radius = kShares[size] * hosts[n].radius;
    ++point.injected, radii[size] += radius;
    if (verdicts[n]->probability < threshold) continue;
    ++found[size], point.mean += verdicts[n]->radius;
    point.rms_error += std::pow(verdicts[n]->radius - radius, 2);
  }
  for (std::size_t size = 0; size < sizes; ++size) {
    NeckRecovery& point = points[size];
    if (point.injected == 0) continue;
    point.radius = radii[size] / static_cast<double>(point.injected);
    point.found = found[size] / static_cast<double>(point.injected);
    if (found[size] == 0.0) continue;
    point.mean /= found[size];
    point.rms_error = std::sqrt(point.rms_error / found[size]);
  }
  return points;
}

}  // namespace pendular::segmentation
