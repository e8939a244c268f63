#include "segmentation/bridges/crevice.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "segmentation/fit/ball_profile.h"
#include "segmentation/fit/rings.h"

namespace pendular::segmentation {
namespace {

constexpr double kWidest = 0.6, kBlurs = 3.0;    // radii and blurs from the axis
constexpr double kInside = 1.5, kDeepest = 3.0;  // blurs into the balls: of what is looked at, of templates
constexpr double kFirstShare = 0.1, kShareStep = 0.0125;
constexpr double kGapStep = 0.2, kRadiusStep = 0.03;
constexpr double kSeen = 0.5;
constexpr double kBackground = 0.1;  // prior standard deviation of the background, over the balls' contrast

double reach_across(double radius, double blur) {
  return kWidest * radius + kBlurs * blur;
}

/// Half of what is between two balls at a distance from their axis.
double half_height(double across, double radius, double gap) {
  return 0.5 * gap + radius - std::sqrt(std::max(0.0, radius * radius - across * across));
}

struct Cell {
  double voxels = 0.0, residual = 0.0, by_radius = 0.0, by_blur = 0.0;  // sums
};

/// Whether a place belongs to something else.
class Elsewhere {
 public:
  Elsewhere(const Volume& volume, std::span<const GreyBall> balls, std::span<const int> others,
            const std::optional<Container>& container, double margin)
      : volume_(volume), container_(container), margin_(margin) {
    for (const int other : others)
      bodies_.emplace_back(balls[other].centre, std::pow(balls[other].radius + margin, 2));
  }

  bool operator()(const Vec3& p) const {
    for (const auto& [centre, reach] : bodies_)
      if ((p - centre).squaredNorm() < reach) return true;
    if (!container_) return false;
    return std::hypot(p.x() - container_->axis_x, p.y() - container_->axis_y) >
               container_->radius - margin_ ||
           (container_->bottom && p.z() < *container_->bottom + margin_) ||
           (container_->top && p.z() > *container_->top - margin_);
  }

  bool in_picture(long i, long j, long k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < static_cast<long>(volume_.size[0]) &&
           j < static_cast<long>(volume_.size[1]) && k < static_cast<long>(volume_.size[2]);
  }

 private:
  const Volume& volume_;
  const std::optional<Container>& container_;
  double margin_;
  std::vector<std::pair<Vec3, double>> bodies_;
};

struct Crevice {
  std::vector<Cell> cells;
  double seen = 0.0;  ///< share
};

template <typename T>
Crevice crevice_of(std::span<const T> pixels, const Volume& volume, std::span<const GreyBall> balls,
                   const BallPair& pair, const Elsewhere& elsewhere, const NeckTemplate& made, double blur,
                   const Rings* rings) {
  const GreyBall &a = balls[pair.i], &b = balls[pair.j];
  const CreviceAxes axes(a, b);
  const double outer = reach_across(pair.radius, blur);
  const Vec3 middle = a.centre + 0.5 * (a.radius + axes.length() - b.radius) * axes.axis();
  const double background = 0.5 * (a.background + b.background);
  Crevice crevice{std::vector<Cell>(made.high * made.wide), 0.0};
  double all = 0.0, seen = 0.0;
  const double half = std::hypot(outer, half_height(outer, pair.radius, pair.gap) + kInside * blur);
  for (long k = std::lround(middle.z() - half); k <= std::lround(middle.z() + half); ++k)
    for (long j = std::lround(middle.y() - half); j <= std::lround(middle.y() + half); ++j)
      for (long i = std::lround(middle.x() - half); i <= std::lround(middle.x() + half); ++i) {
        const Vec3 p(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const auto place = axes.place(p);
        if (place.across2 >= outer * outer) continue;
        const double left = axes.length() - place.along;
        const double ra = std::sqrt(place.along * place.along + place.across2);
        const double rb = std::sqrt(left * left + place.across2);
        if (ra < a.radius - kInside * blur || rb < b.radius - kInside * blur) continue;
        const auto [u, half_here] = axes.height(place);
        const auto row = static_cast<std::size_t>(u / NeckTemplate::kCell),
                   column = static_cast<std::size_t>(std::sqrt(place.across2) / NeckTemplate::kCell);
        if (row >= made.high || column >= made.wide || u > half_here + kInside * blur) continue;
        all += 1.0;
        if (!elsewhere.in_picture(i, j, k) || elsewhere(p)) continue;
        const double grey = grey_at(pixels, volume, rings, i, j, k);
        if (std::isnan(grey)) continue;
        seen += 1.0;
        const BallProfile pa = ball_profile(ra, a.radius, blur), pb = ball_profile(rb, b.radius, blur);
        Cell& cell = crevice.cells[row * made.wide + column];
        cell.voxels += 1.0;
        cell.residual += grey - background - a.contrast * pa.value - b.contrast * pb.value;
        cell.by_radius += a.contrast * pa.by_radius + b.contrast * pb.by_radius;
        cell.by_blur += a.contrast * pa.by_blur + b.contrast * pb.by_blur;
      }
  crevice.seen = all > 0.0 ? seen / all : 0.0;
  return crevice;
}

}  // namespace

BallPair ball_pair(std::span<const GreyBall> balls, int i, int j) {
  const GreyBall &a = balls[i], &b = balls[j];
  return {i, j, (a.centre - b.centre).norm() - a.radius - b.radius,
          2.0 * a.radius * b.radius / (a.radius + b.radius)};
}

CreviceAxes::CreviceAxes(const GreyBall& a, const GreyBall& b)
    : centre_(a.centre),
      axis_((b.centre - a.centre).normalized()),
      length_((b.centre - a.centre).norm()),
      square_a_(a.radius * a.radius),
      square_b_(b.radius * b.radius) {}

CreviceAxes::Place CreviceAxes::place(const Vec3& p) const {
  const Vec3 from = p - centre_;
  const double along = axis_.dot(from);
  return {along, from.squaredNorm() - along * along};
}

CreviceAxes::Height CreviceAxes::height(const Place& place) const {
  const double of_a = std::sqrt(std::max(0.0, square_a_ - place.across2));
  const double of_b = length_ - std::sqrt(std::max(0.0, square_b_ - place.across2));
  return {std::fabs(place.along - 0.5 * (of_a + of_b)), 0.5 * (of_b - of_a)};
}

std::span<const double> neck_shares() {
  static const std::vector<double> shares = [] {
    std::vector<double> all;
    for (int k = 0; k <= 40; ++k) all.push_back(kFirstShare + kShareStep * k);
    return all;
  }();
  return shares;
}

double NeckTemplate::at(double share, double from_middle, double across) const {
  const auto row = static_cast<std::size_t>(from_middle / kCell),
             column = static_cast<std::size_t>(across / kCell);
  if (row >= high || column >= wide) return 0.0;
  const double last = static_cast<double>(necks.size() - 1);
  const double place = std::clamp((share - kFirstShare) / kShareStep, 0.0, last);
  const auto size = std::min(static_cast<std::size_t>(place), necks.size() - 2);
  // By the means of cells: between the centres of the four nearest, of either size.
  const double u = std::max(0.0, from_middle / kCell - 0.5), v = std::max(0.0, across / kCell - 0.5);
  const auto i = static_cast<std::size_t>(u), j = static_cast<std::size_t>(v);
  const double w[] = {u - static_cast<double>(i), v - static_cast<double>(j),
                      place - static_cast<double>(size)};
  double sum = 0.0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    if (i + a >= high || j + b >= wide) continue;
    sum += (a ? w[0] : 1.0 - w[0]) * (b ? w[1] : 1.0 - w[1]) * (c ? w[2] : 1.0 - w[2]) *
           static_cast<double>(necks[size + c][(i + a) * wide + j + b]);
  }
  return sum;
}

NeckTemplates::Key NeckTemplates::key_of(const BallPair& pair) {
  return {std::lround(pair.gap / kGapStep), std::lround(std::log(pair.radius) / kRadiusStep)};
}

NeckTemplates::NeckTemplates(std::span<const BallPair> pairs, double blur) {
  for (const auto& pair : pairs) templates_.try_emplace(key_of(pair));
  const auto shares = neck_shares();
  std::vector<std::pair<Key, NeckTemplate*>> open;
  for (auto& [key, made] : templates_) {
    open.emplace_back(key, &made);
    made.necks.resize(shares.size());
  }
  const phantom::Sharpness sharpness(std::sqrt(std::max(0.05, blur * blur - 1.0 / 12.0)));
  for_blocks(open.size() * shares.size(), 1, [&](std::size_t n, std::size_t) {
    const auto& [key, made] = open[n / shares.size()];
    const double gap = kGapStep * static_cast<double>(key.first);
    const double radius = std::exp(kRadiusStep * static_cast<double>(key.second)),
                 length = 2.0 * radius + gap;
    const double across = reach_across(radius * (1.0 + kRadiusStep), blur);
    const double up = half_height(std::min(across, 0.95 * radius), radius, gap) + kDeepest * blur;
    const auto high = static_cast<std::size_t>(up / NeckTemplate::kCell) + 2,
               wide = static_cast<std::size_t>(across / NeckTemplate::kCell) + 1;
    const phantom::Neck neck{
        {Vec3::Zero(), radius}, {Vec3(0.0, 0.0, length), radius}, shares[n % shares.size()] * radius};
    const phantom::NeckImage image(neck, sharpness);
    auto& cells = made->necks[n % shares.size()];
    for (std::size_t u = 0; u < high; ++u)
      for (std::size_t r = 0; r < wide; ++r)
        cells.push_back(
            static_cast<float>(image.at(0.5 * length + (static_cast<double>(u) + 0.5) * NeckTemplate::kCell,
                                        (static_cast<double>(r) + 0.5) * NeckTemplate::kCell)));
    if (n % shares.size() == 0) made->high = high, made->wide = wide;
  });
}

const NeckTemplate& NeckTemplates::of(const BallPair& pair) const {
  return templates_.at(key_of(pair));
}

std::optional<NeckEvidence> neck_evidence(const Volume& volume, std::span<const GreyBall> balls,
                                          const BallPair& pair, std::span<const int> others,
                                          const std::optional<Container>& container,
                                          const ImageKnowledge& knowledge, const NeckTemplates& templates) {
  const NeckTemplate& made = templates.of(pair);
  const Elsewhere elsewhere(volume, balls, others, container, kBlurs * knowledge.blur);
  const Crevice crevice = with_pixels(volume, [&](auto pixels) {
    return crevice_of(pixels, volume, balls, pair, elsewhere, made, knowledge.blur, knowledge.rings);
  });
  if (crevice.seen < kSeen) return std::nullopt;
  const double contrast = 0.5 * (balls[pair.i].contrast + balls[pair.j].contrast);

  // Free besides the neck: background, both radii, blur; with what is known of them beforehand.
  Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto columns = [](const Cell& cell) {
    return Eigen::Vector3d(1.0, cell.by_radius / cell.voxels, cell.by_blur / cell.voxels);
  };
  for (const Cell& cell : crevice.cells) {
    if (cell.voxels == 0.0) continue;
    const Eigen::Vector3d column = columns(cell);
    free += cell.voxels * column * column.transpose();
    right += cell.residual * column;
  }
  const double variance = knowledge.noise_variance;
  free.diagonal() += variance * Eigen::Vector3d(std::pow(kBackground * contrast, -2),
                                                2.0 * std::pow(knowledge.sigma_radius, -2),
                                                std::pow(knowledge.sigma_blur, -2));
  const Eigen::LLT<Eigen::Matrix3d> factor(free);
  const Eigen::Vector3d solved = factor.solve(right);
  NeckEvidence evidence;
  for (const auto& neck : made.necks) {
    Eigen::Vector3d with_free = Eigen::Vector3d::Zero();
    double with_residual = 0.0, square = 0.0;
    for (std::size_t c = 0; c < crevice.cells.size(); ++c) {
      const Cell& cell = crevice.cells[c];
      if (cell.voxels == 0.0 || neck[c] < 1e-4F) continue;
      const double grey = contrast * static_cast<double>(neck[c]);
      with_free += cell.voxels * grey * columns(cell);
      with_residual += grey * cell.residual;
      square += cell.voxels * grey * grey;
    }
    evidence.n.push_back((with_residual - with_free.dot(solved)) / variance);
    evidence.d.push_back((square - with_free.dot(factor.solve(with_free))) / variance);
  }
  return evidence;
}

}  // namespace pendular::segmentation
