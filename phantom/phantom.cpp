#include "phantom/phantom.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/random.h"
#include "phantom/phantom_blur.h"
#include "phantom/phantom_raster.h"

namespace pendular::phantom {
namespace {

constexpr int slab = 16;  // slices finished together
constexpr int kMostVoxelsAlong = std::numeric_limits<int>::max() / 2;

// Purposes of random numbers, each with a stream of its own.
enum class Stream : std::uint64_t { necks, white_noise, correlated_noise, rings };

std::uint64_t stream_seed(std::uint64_t seed, Stream stream) {
  return random_bits(seed, static_cast<std::uint64_t>(stream));
}

bool holds_polymer(const Bridge& bridge) {
  return bridge.state == BridgeState::bridge || bridge.state == BridgeState::candidate;
}

/// Everything to be drawn, in voxels of the volume.
struct Scene {
  int nx = 0, ny = 0, nz = 0;
  std::vector<Ball> balls;
  std::vector<Neck> necks;
  double axis_x = 0.0, axis_y = 0.0, inner_radius = 0.0, outer_radius = 0.0, bottom = 0.0, top = 0.0;

  std::size_t slice_voxels() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
};

/// What does not change from slice to slice, per voxel of one.
struct Plane {
  std::vector<float> wall, bore;  ///< share filled by the container's tube, and of what lies inside it
  std::vector<float> dimming;     ///< b(ϱ)
  std::vector<float> rings;       ///< over the edge
};

Volume empty_volume(const Specimen& specimen, const Sample::Phantom& settings) {
  const double around = 2.0 * settings.margin;
  const double width = specimen.diameter + 2.0 * settings.wall_thickness + around;
  const double across = std::ceil(width / settings.voxel - 1e-6);
  const double along = std::ceil((specimen.height + around) / settings.voxel - 1e-6);
  if (!(across >= 1.0 && along >= 1.0))
    bad_input("phantom: specimen of {:.6g} x {:.6g} um with voxels of {:.6g} um: expected at least one voxel",
              specimen.diameter * 1e6, specimen.height * 1e6, settings.voxel * 1e6);
  const double noise_slices =
      settings.correlated_noise > 0.0 ? 2.0 * slab + 8.0 * settings.correlation_voxels : 0.0;
  const double needed =
      across * across * (along * settings.bits / 8.0 + sizeof(float) * (noise_slices + 16.0));
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  if (needed > memory || across > kMostVoxelsAlong || along > kMostVoxelsAlong)
    throw ComputationFailed(fmt::format(
        "phantom: {:.0f} x {:.0f} x {:.0f} voxels need {:.3g} GB of memory, this machine has {:.3g} GB: "
        "choose a larger phantom.voxel_um or a smaller specimen",
        across, across, along, needed * 1e-9, memory * 1e-9));
  Volume volume;
  volume.size = {static_cast<std::size_t>(across), static_cast<std::size_t>(across),
                 static_cast<std::size_t>(along)};
  volume.spacing = settings.voxel;
  volume.origin = Vec3(specimen.axis_x, specimen.axis_y, specimen.bottom + 0.5 * specimen.height) -
                  0.5 * settings.voxel * Vec3(across - 1.0, across - 1.0, along - 1.0);
  if (settings.bits == 8.0)
    volume.pixels.emplace<std::vector<std::uint8_t>>(volume.voxels());
  else
    volume.pixels.emplace<std::vector<std::uint16_t>>(volume.voxels());
  return volume;
}

Scene scene_of(const Packing& packing, const Volume& volume, const Sample::Phantom& settings) {
  Scene scene;
  scene.nx = static_cast<int>(volume.size[0]);
  scene.ny = static_cast<int>(volume.size[1]);
  scene.nz = static_cast<int>(volume.size[2]);
  for (const Bead& bead : packing.beads) {
    if (!bead.centre.allFinite() || !(bead.diameter > 0.0) || !std::isfinite(bead.diameter))
      bad_input("phantom: bead {}: found diameter {} um, expected a finite centre and a positive diameter",
                bead.id, bead.diameter * 1e6);
    scene.balls.push_back(
        {(bead.centre - volume.origin) / volume.spacing, 0.5 * bead.diameter / volume.spacing});
  }
  for (const Bridge& bridge : packing.bridges) {
    if (!holds_polymer(bridge) || bridge.diameter == 0.0) continue;
    const auto i = static_cast<std::size_t>(bridge.i), j = static_cast<std::size_t>(bridge.j);
    const double thickest = std::min(packing.beads[i].diameter, packing.beads[j].diameter);
    if (!(bridge.diameter > 0.0 && bridge.diameter < thickest))
      bad_input(
          "phantom: bridge of beads {} and {}: found neck diameter {} um, expected above 0 and below {} um",
          packing.beads[i].id, packing.beads[j].id, bridge.diameter * 1e6, thickest * 1e6);
    scene.necks.push_back({scene.balls[i], scene.balls[j], 0.5 * bridge.diameter / volume.spacing});
  }
  const Specimen& specimen = packing.specimen;
  scene.axis_x = (specimen.axis_x - volume.origin.x()) / volume.spacing;
  scene.axis_y = (specimen.axis_y - volume.origin.y()) / volume.spacing;
  scene.inner_radius = 0.5 * specimen.diameter / volume.spacing;
  scene.outer_radius = scene.inner_radius + settings.wall_thickness / volume.spacing;
  scene.bottom = (specimen.bottom - volume.origin.z()) / volume.spacing;
  scene.top = scene.bottom + specimen.height / volume.spacing;
  return scene;
}

Plane plane_of(const Scene& scene, const Sample::Phantom& settings, const Sharpness& sharpness,
               std::uint64_t seed) {
  Plane plane;
  for (auto* map : {&plane.wall, &plane.bore, &plane.dimming, &plane.rings})
    map->resize(scene.slice_voxels());
  const std::uint64_t ring_seed = stream_seed(seed, Stream::rings);
  for_blocks(static_cast<std::size_t>(scene.ny), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y) {
      for (std::size_t x = 0; x < static_cast<std::size_t>(scene.nx); ++x) {
        const std::size_t voxel = y * static_cast<std::size_t>(scene.nx) + x;
        const double dx = static_cast<double>(x) - scene.axis_x, dy = static_cast<double>(y) - scene.axis_y;
        const double bore = disc_share(dx, dy, scene.inner_radius, sharpness);
        plane.bore[voxel] = static_cast<float>(bore);
        plane.wall[voxel] = static_cast<float>(disc_share(dx, dy, scene.outer_radius, sharpness) - bore);
        const double depth = 1.0 - (dx * dx + dy * dy) / (scene.outer_radius * scene.outer_radius);
        plane.dimming[voxel] = static_cast<float>(1.0 - settings.beam_hardening * std::max(0.0, depth));
        if (settings.rings == 0.0) continue;
        const double from_middle = std::hypot(static_cast<double>(x) - 0.5 * (scene.nx - 1),
                                              static_cast<double>(y) - 0.5 * (scene.ny - 1));
        const auto ring = static_cast<std::uint64_t>(std::floor(from_middle));
        plane.rings[voxel] = static_cast<float>(settings.rings * random_normal(ring_seed, ring));
      }
    }
  });
  return plane;
}

void draw_white_noise(std::uint64_t seed, std::uint64_t first, std::span<float> slice) {
  for (std::size_t i = 0; i < slice.size(); ++i)
    slice[i] = static_cast<float>(random_normal(seed, first + i));
}

/// Makes the volume's slices in order, a slab at a time, holding only the necks and noise that the slab
/// needs.
class Scanner {
 public:
  Scanner(const Scene& scene, const Sample::Phantom& settings, std::uint64_t seed)
      : scene_(scene),
        settings_(settings),
        seed_(seed),
        sharpness_(settings.blur_voxels),
        plane_(plane_of(scene, settings, sharpness_, seed)),
        correlation_(settings.correlated_noise > 0.0 ? settings.correlation_voxels : 0.0),
        noise_(settings.correlated_noise > 0.0 ? scene.slice_voxels() : 0, slab + 2 * correlation_.radius()),
        next_noise_(-correlation_.radius()),
        necks_(scene.necks.size()) {}

  /// Fills slices [first, last) of `pixels`, at most a slab of them; calls follow each other upwards.
  template <typename Pixel>
  void scan(int first, int last, std::span<Pixel> pixels) {
    prepare_necks(first, last);
    if (settings_.correlated_noise > 0.0) draw_noise(last + correlation_.radius());
    for_blocks(static_cast<std::size_t>(last - first), 1, [&](std::size_t k, std::size_t) {
      const int z = first + static_cast<int>(k);
      std::vector<float> value(scene_.slice_voxels());
      draw_matter(z, value);
      finish_slice(z, value, pixels);
    });
  }

 private:
  void prepare_necks(int first, int last) {
    for_blocks(necks_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Neck& neck = scene_.necks[k];
        const double reach = neck.radius + sharpness_.reach();
        const double lowest = std::min(neck.a.centre.z(), neck.b.centre.z()) - reach;
        const double highest = std::max(neck.a.centre.z(), neck.b.centre.z()) + reach;
        if (highest < first || lowest > last)
          necks_[k].reset();
        else if (!necks_[k])
          necks_[k] = std::make_unique<NeckImage>(neck, sharpness_);
      }
    });
  }

  void draw_noise(int last) {
    for_blocks(static_cast<std::size_t>(last - next_noise_), 1, [&](std::size_t k, std::size_t) {
      const int z = next_noise_ + static_cast<int>(k);
      const auto index = static_cast<std::uint64_t>(z + correlation_.radius()) * scene_.slice_voxels();
      std::vector<float> scratch(scene_.slice_voxels());
      draw_white_noise(stream_seed(seed_, Stream::correlated_noise), index, noise_.slice(z));
      smooth_slice(noise_.slice(z), scene_.nx, scene_.ny, correlation_, scratch);
    });
    next_noise_ = last;
  }

  /// psf ⊗ m of the slice.
  void draw_matter(int z, std::span<float> slice) const {
    std::vector<float> polymer(slice.size());
    for (const Ball& ball : scene_.balls) add_ball(ball, sharpness_, {slice, scene_.nx, scene_.ny, z});
    for (const auto& neck : necks_)
      if (neck && neck->touches(z)) neck->add_to({polymer, scene_.nx, scene_.ny, z});

    const auto piston_share = static_cast<float>(half_space_share(scene_.bottom - z, sharpness_) +
                                                 half_space_share(z - scene_.top, sharpness_));
    const auto polymer_grey = static_cast<float>(settings_.polymer_contrast);
    const auto wall_grey = static_cast<float>(settings_.wall_contrast);
    const auto piston_grey = static_cast<float>(settings_.piston_contrast);
    for (std::size_t i = 0; i < slice.size(); ++i) {
      float left = 1.0F;
      const auto take = [&left](float share) {
        share = std::min(share, left);
        left -= share;
        return share;
      };
      const float glass = take(slice[i]);
      const float bonded = polymer_grey * take(polymer[i]);
      const float wall = wall_grey * take(plane_.wall[i]);
      slice[i] = glass + bonded + wall + piston_grey * take(plane_.bore[i] * piston_share);
    }
  }

  template <typename Pixel>
  void finish_slice(int z, std::span<float> matter, std::span<Pixel> pixels) {
    constexpr float full = std::numeric_limits<Pixel>::max();
    const auto air = full * static_cast<float>(settings_.air_grey);
    const auto edge = full * static_cast<float>(settings_.glass_grey - settings_.air_grey);
    const double smoothed_sd = std::pow(correlation_.sum_of_squares(), 1.5);
    const auto correlated = static_cast<float>(settings_.correlated_noise / smoothed_sd);
    const std::uint64_t noise_seed = stream_seed(seed_, Stream::white_noise);
    const auto width = static_cast<std::size_t>(scene_.nx);
    std::vector<float> extra(width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(scene_.ny); ++y) {
      const std::size_t row = y * width;
      const std::size_t first = static_cast<std::size_t>(z) * scene_.slice_voxels() + row;
      const auto value = matter.subspan(row, width);
      for (std::size_t x = 0; x < width; ++x)
        value[x] = plane_.dimming[row + x] * value[x] + plane_.rings[row + x];
      if (settings_.correlated_noise > 0.0) {
        noise_.smoothed(z, row, correlation_, extra);
        for (std::size_t x = 0; x < width; ++x) value[x] += correlated * extra[x];
      }
      if (settings_.noise > 0.0)
        for (std::size_t x = 0; x < width; ++x)
          value[x] += static_cast<float>(settings_.noise * random_normal(noise_seed, first + x));
      for (std::size_t x = 0; x < width; ++x)  // never negative. NOLINTNEXTLINE(bugprone-incorrect-roundings)
        pixels[first + x] = static_cast<Pixel>(std::clamp(air + edge * value[x], 0.0F, full) + 0.5F);
    }
  }

  const Scene& scene_;
  const Sample::Phantom& settings_;
  std::uint64_t seed_;
  Sharpness sharpness_;
  Plane plane_;
  GaussianKernel correlation_;
  SliceRing noise_;
  int next_noise_;
  std::vector<std::unique_ptr<NeckImage>> necks_;  ///< of those in the slab's reach
};

}  // namespace

void draw_neck_diameters(Packing& packing, const Sample& sample, std::uint64_t seed) {
  constexpr std::uint64_t draws = 64;  // at most; the last is clamped where none falls inside
  const std::uint64_t neck_seed = stream_seed(seed, Stream::necks);
  for (std::size_t k = 0; k < packing.bridges.size(); ++k) {
    Bridge& bridge = packing.bridges[k];
    if (!holds_polymer(bridge)) continue;
    bridge.state = BridgeState::bridge;
    if (bridge.diameter > 0.0) continue;
    const double smaller = std::min(packing.beads[static_cast<std::size_t>(bridge.i)].diameter,
                                    packing.beads[static_cast<std::size_t>(bridge.j)].diameter);
    const double lowest = 0.2 * smaller, highest = 0.9 * smaller;
    double drawn = 0.0;
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
      const double normal = random_normal(neck_seed, k * draws + draw);
      drawn = sample.bridges.diameter + sample.bridges.diameter_sd * normal;
      if (drawn >= lowest && drawn <= highest) break;
    }
    bridge.diameter = std::clamp(drawn, lowest, highest);
  }
}

Volume make_phantom(const Packing& packing, const Sample::Phantom& settings, std::uint64_t seed) {
  Volume volume = empty_volume(packing.specimen, settings);
  const Scene scene = scene_of(packing, volume, settings);
  Scanner scanner(scene, settings, seed);
  Progress progress("phantom", scene.nz);
  std::visit(
      [&]<typename Pixel>(std::vector<Pixel>& pixels) {
        if constexpr (std::is_same_v<Pixel, std::uint8_t> || std::is_same_v<Pixel, std::uint16_t>)
          for (int z = 0; z < scene.nz; z += slab) {
            stop_if_interrupted();
            const int last = std::min(z + slab, scene.nz);
            scanner.scan(z, last, std::span(pixels));
            progress.update(last);
          }
      },
      volume.pixels);
  return volume;
}

}  // namespace pendular::phantom
