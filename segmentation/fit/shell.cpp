#include "segmentation/fit/shell.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "segmentation/fit/rings.h"

namespace pendular::segmentation {
namespace {

/// A neighbour, relative to the ball's centre.
struct Body {
  std::array<double, 3> to, direction;
  double reach_squared;
  double cosine;  ///< of the cone's half-angle; above 1: no cone
};

/// A negative number for each voxel that lies within a neighbour or its cone.
struct MarkHidden {
  static inline __attribute__((always_inline)) void run(const ShellVoxels* voxels,
                                                        const std::vector<Body>* bodies, LaneNumbers* marks) {
    for (std::size_t n = 0; n < voxels->size(); n += kLanes) {
      const auto& block = voxels->blocks()[n / kLanes];
      Lanes x, y, z, r;
      load(block.x, x), load(block.y, y), load(block.z, z);
      set_root(x * x + y * y + z * z, r);
      LaneBits signs{};
      for (const Body& body : *bodies) {
        const Lanes dx = x - body.to[0], dy = y - body.to[1], dz = z - body.to[2];
        const Lanes outside = dx * dx + dy * dy + dz * dz - body.reach_squared;
        const Lanes beside =
            body.cosine * r - (x * body.direction[0] + y * body.direction[1] + z * body.direction[2]);
        signs |= (LaneBits)outside | (LaneBits)beside;
      }
      lanes_of(marks[n / kLanes]) = (Lanes)signs;
    }
  }
};

/// What hides a shell: the cones and bodies of the neighbours, and the container.
class Hidden {
 public:
  /// `margin` about the neighbours.
  Hidden(std::span<const GreyBall> balls, std::size_t own, std::span<const Neighbour> neighbours,
         const std::optional<Container>& container, const FitSetting& setting, double margin)
      : centre_(balls[own].centre),
        container_(container ? &*container : nullptr),
        margin_(setting.half_width) {
    const double sine = std::min(0.95, setting.cone / balls[own].radius),
                 cosine = std::sqrt(1.0 - sine * sine);
    for (const Neighbour& other : neighbours) {
      const GreyBall& ball = balls[other.ball];
      const Vec3 to = ball.centre - centre_, direction = to.normalized();
      const double reach = ball.radius + margin;
      bodies_.push_back({{to.x(), to.y(), to.z()},
                         {direction.x(), direction.y(), direction.z()},
                         reach * reach,
                         other.polymer ? cosine : 2.0});
    }
    if (container && free_of(*container, balls[own].radius + 2.0 * margin_)) container_ = nullptr;
  }

  /// Signs: negative where neighbours hide a voxel.
  VoxelNumbers by_neighbours(const ShellVoxels& voxels) const {
    VoxelNumbers marks(voxels);
    run_widest<MarkHidden>(&voxels, &bodies_, marks.blocks());
    return marks;
  }

  /// `p` relative to the ball's centre.
  bool by_container(const Vec3& p) const {
    if (!container_) return false;
    const double z = centre_.z() + p.z();
    return std::hypot(centre_.x() + p.x() - container_->axis_x, centre_.y() + p.y() - container_->axis_y) >
               container_->radius - margin_ ||
           (container_->bottom && z < *container_->bottom + margin_) ||
           (container_->top && z > *container_->top - margin_);
  }

 private:
  /// Whether the container is further than `reach` from the centre.
  bool free_of(const Container& container, double reach) const {
    return std::hypot(centre_.x() - container.axis_x, centre_.y() - container.axis_y) + reach <
               container.radius &&
           !(container.bottom && centre_.z() < *container.bottom + reach) &&
           !(container.top && centre_.z() > *container.top - reach);
  }

  Vec3 centre_;
  std::vector<Body> bodies_;
  const Container* container_;  ///< none where it is out of reach
  double margin_;               ///< about the container
};

/// Voxels of one slice of a shell, every so many, and where they are in the volume.
struct Slice {
  ShellVoxels voxels;  ///< without grey values
  std::vector<std::array<long, 2>> columns;
};

/// What takes every so many of the voxels that it is shown, row by row, and has them fetched from memory.
template <typename T>
class Taker {
 public:
  Taker(std::span<const T> pixels, const Volume& volume, const Vec3& centre, std::size_t stride)
      : pixels_(pixels), volume_(volume), centre_(centre), stride_(static_cast<long>(stride)) {}

  /// Of a row those from `first` to `last`, if there are any.
  void take(long first, long last, long j, long k, Slice& slice) {
    if (first > last) return;
    seen_ += static_cast<std::size_t>(last - first + 1);
    long i = first + to_skip_;
    for (; i <= last; i += stride_) {
      if (!inside(i, 0) || !inside(j, 1)) continue;
      slice.voxels.push_back({static_cast<float>(static_cast<double>(i) - centre_.x()),
                              static_cast<float>(static_cast<double>(j) - centre_.y()),
                              static_cast<float>(static_cast<double>(k) - centre_.z()), 0.0F});
      slice.columns.push_back({i, j});
      if (inside(k, 2)) __builtin_prefetch(&pixels_[place_of(volume_, i, j, k)]);
    }
    to_skip_ = i - last - 1;
  }

  bool inside(long k, std::size_t axis) const { return k >= 0 && k < static_cast<long>(volume_.size[axis]); }
  std::size_t seen() const { return seen_; }

 private:
  std::span<const T> pixels_;
  const Volume& volume_;
  Vec3 centre_;
  long stride_, to_skip_ = 0;
  std::size_t seen_ = 0;
};

/// Calls see(k, slice) for each slice of the shell between two radii; returns how many voxels there are,
/// outside the volume, too.
template <typename T, typename See>
std::size_t for_slices(std::span<const T> pixels, const Volume& volume, const Vec3& centre, double inner,
                       double outer, std::size_t stride, const See& see) {
  const auto first_from = [](double place) { return static_cast<long>(std::ceil(place)); };
  const auto last_to = [](double place) { return static_cast<long>(std::floor(place)); };
  Taker taker(pixels, volume, centre, stride);
  Slice slice;
  for (long k = first_from(centre.z() - outer); k <= last_to(centre.z() + outer); ++k) {
    slice.voxels.clear(), slice.columns.clear();
    for (long j = first_from(centre.y() - outer); j <= last_to(centre.y() + outer); ++j) {
      const double y = static_cast<double>(j) - centre.y(), z = static_cast<double>(k) - centre.z();
      const double within = outer * outer - y * y - z * z, hollow = inner * inner - y * y - z * z;
      if (within < 0.0) continue;
      const long first = first_from(centre.x() - std::sqrt(within)),
                 last = last_to(centre.x() + std::sqrt(within));
      if (hollow > 0.0) {
        taker.take(first, last_to(centre.x() - std::sqrt(hollow)), j, k, slice);
        taker.take(first_from(centre.x() + std::sqrt(hollow)), last, j, k, slice);
      } else {
        taker.take(first, last, j, k, slice);
      }
    }
    if (taker.inside(k, 2)) see(k, slice);
  }
  return taker.seen();
}

}  // namespace

Shell shell_about(const Volume& volume, std::span<const GreyBall> balls, std::size_t own,
                  std::span<const Neighbour> neighbours, const std::optional<Container>& container,
                  const FitSetting& setting, const GreyAt& known) {
  constexpr double inwards =
      3.0;  // at least: within the ball there is nothing else, and its level is to be seen
  const GreyBall& ball = balls[own];
  const double inner = std::max(0.5, ball.radius - std::max(inwards, setting.half_width)),
               outer = ball.radius + setting.half_width;
  const Hidden hidden(balls, own, neighbours, container, setting, known ? 0.0 : setting.half_width);
  Shell shell;
  const std::size_t all = with_pixels(volume, [&](auto pixels) {
    return for_slices(
        pixels, volume, ball.centre, inner, outer, setting.stride, [&](long k, const Slice& slice) {
          auto marks = hidden.by_neighbours(slice.voxels);
          for (std::size_t n = 0; n < slice.voxels.size(); ++n) {
            if (std::signbit(marks[n])) continue;
            ShellVoxel voxel = slice.voxels[n];
            const Vec3 p(voxel.x, voxel.y, voxel.z);
            if (hidden.by_container(p)) continue;
            double grey = grey_at(pixels, volume, setting.rings, slice.columns[n][0], slice.columns[n][1], k);
            if (std::isnan(grey)) continue;
            if (known) grey -= known(ball.centre + p);
            voxel.grey = static_cast<float>(grey);
            shell.voxels.push_back(voxel);
          }
        });
  });
  const double free = static_cast<double>(shell.voxels.size() * setting.stride);
  shell.free_share = all ? free / static_cast<double>(all) : 0.0;
  return shell;
}

}  // namespace pendular::segmentation
