#include "pipette/phantom.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "pipette/codecs.h"

namespace pendular::pipette {
namespace {

constexpr double kBackground = 0.72;

/// Where things are in the first frame. The free bead is to the left, the wafer to the right.
struct Layout {
  Point pull, free_bead, fixed_bead, pipette, reference;
  double radius;
};

Layout layout(const Phantom& p) {
  Layout l;
  l.radius = 0.5 * p.bead_diameter;
  l.pull = p.direction == Direction::normal ? Point(1.0, 0.0) : Point(0.0, 1.0);
  const double gap = 1.5, room = p.direction == Direction::normal ? 0.5 * p.stage_travel : 0.0;
  const Point middle(0.52 * p.width - room + 0.23,
                     0.56 * p.height + 0.37 - (l.pull.y() * 0.5 * p.stage_travel));
  l.free_bead = middle - Point(l.radius + 0.5 * gap, 0.0);
  l.fixed_bead = middle + Point(l.radius + 0.5 * gap, 0.0);
  l.pipette = l.free_bead - Point(l.radius + 13.0, 0.0);
  l.reference = Point(20.0, p.height - 14.0);
  return l;
}

/// Share of a half plane seen at a signed distance inside it, after a Gaussian blur.
double edge(double inside, double sigma) {
  const double far = inside / (std::sqrt(2.0) * sigma);
  return far > 6.0 ? 1.0 : far < -6.0 ? 0.0 : 0.5 * std::erfc(-far);  // within rounding of a full one
}

class Painter {
 public:
  Painter(GreyImage& image, double blur) : image_(image), sigma_(std::sqrt(blur * blur + 1.0 / 12.0)) {}

  /// Mixes a grey into the picture by the coverage of a shape within a box around it.
  template <typename Coverage, typename Grey>
  void shape(const Point& low, const Point& high, const Coverage& coverage, const Grey& grey) {
    for (int y = std::max(0, down(low.y())); y <= std::min(image_.height - 1, down(high.y())); ++y)
      for (int x = std::max(0, down(low.x())); x <= std::min(image_.width - 1, down(high.x())); ++x) {
        const Point at(x, y);
        const double share = coverage(at);
        if (share > 0.0) image_.at(x, y) += share * (grey(at) - image_.at(x, y));
      }
  }

  void bead(const Point& centre, double radius) {
    const Point half = Point::Constant(radius + 5.0 * sigma_);
    shape(
        centre - half, centre + half,
        [&](const Point& at) { return edge(radius - (at - centre).norm(), sigma_); },
        [&](const Point& at) {  // a ball lens: bright in the middle, dark towards the rim
          const double r2 = (at - centre).squaredNorm() / (radius * radius);
          return 0.22 + 0.38 * std::exp(-3.5 * r2);
        });
  }

  void rectangle(const Point& low, const Point& high, double grey) {
    const Point rim = Point::Constant(5.0 * sigma_);
    shape(
        low - rim, high + rim,
        [&](const Point& at) {
          return (edge(at.x() - low.x(), sigma_) - edge(at.x() - high.x(), sigma_)) *
                 (edge(at.y() - low.y(), sigma_) - edge(at.y() - high.y(), sigma_));
        },
        [&](const Point&) { return grey; });
  }

  /// Gaussian spots of either sign scattered within a disc.
  void speckles(const Point& centre, double radius, double amplitude, int count, std::uint64_t seed) {
    for (int k = 0; k < count; ++k) {
      const auto draw = [&](int n) { return random_uniform(seed, static_cast<std::uint64_t>(5 * k + n)); };
      const double r = radius * std::sqrt(draw(0)), angle = 2.0 * M_PI * draw(1);
      const double size = 0.9 + 1.4 * draw(2), blurred = std::hypot(size, sigma_);
      const double height =
          (draw(3) < 0.5 ? -1.0 : 1.0) * amplitude * (0.5 + draw(4)) * size * size / (blurred * blurred);
      const Point spot = centre + r * Point(std::cos(angle), std::sin(angle));
      const int reach = static_cast<int>(std::ceil(5.0 * blurred));
      const auto along = [&](double middle, int pixels) {
        Bell bell{std::max(0, down(middle) - reach), {}};
        for (int at = bell.first; at <= std::min(pixels - 1, down(middle) + reach + 1); ++at)
          bell.values.push_back(std::exp(-0.5 * (at - middle) * (at - middle) / (blurred * blurred)));
        return bell;
      };
      const Bell in_x = along(spot.x(), image_.width), in_y = along(spot.y(), image_.height);
      for (std::size_t y = 0; y < in_y.values.size(); ++y)
        for (std::size_t x = 0; x < in_x.values.size(); ++x)
          image_.at(in_x.first + static_cast<int>(x), in_y.first + static_cast<int>(y)) +=
              height * in_y.values[y] * in_x.values[x];
    }
  }

 private:
  /// A Gaussian along one axis, at pixels from `first` on.
  struct Bell {
    int first;
    std::vector<double> values;
  };
  static int down(double v) { return static_cast<int>(std::floor(v)); }
  GreyImage& image_;
  double sigma_;
};

/// Light, noise and the camera's steps.
void expose(GreyImage& image, const Phantom& p, int frame) {
  const double t = static_cast<double>(frame) / frames_of(p);
  const double steps = std::pow(2.0, p.bits) - 1.0;
  const std::uint64_t seed = random_bits(p.seed, 1000 + static_cast<std::uint64_t>(frame));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double slope = 0.03 * (static_cast<double>(x) / image.width - 0.5);
      double& value = image.at(x, y);
      value *= 1.0 + p.light * t + slope;
      const double sd =
          std::sqrt(p.read_noise * p.read_noise + p.shot_noise * p.shot_noise * std::max(value, 0.0));
      if (sd > 0.0)
        value +=
            sd * random_normal(seed, static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(image.width) +
                                         static_cast<std::uint64_t>(x));
      value = std::clamp(std::round(value * steps) / steps, 0.0, 1.0);
    }
}

Region around(const Point& centre, double half_width, double half_height) {
  const int x = static_cast<int>(std::lround(centre.x() - half_width)),
            y = static_cast<int>(std::lround(centre.y() - half_height));
  return {x, y, static_cast<int>(std::lround(2.0 * half_width)),
          static_cast<int>(std::lround(2.0 * half_height))};
}

}  // namespace

int frames_of(const Phantom& phantom) {
  return phantom.still + phantom.loading + phantom.unloading;
}

PhantomMotion phantom_motion(const Phantom& p, int frame) {
  PhantomMotion motion;
  const double step = p.stage_travel / p.loading;
  const int turn = p.still + p.loading - 1;
  const int steps =
      frame <= turn ? std::max(0, frame - p.still + 1) : std::max(0, p.loading - (frame - turn));
  motion.wafer = step * steps;
  // F = k (e − softening e²/(2 e_max)), where e_max is the extension of a linear bridge at full travel.
  const double ratio = p.pipette_stiffness / p.bridge_stiffness;
  const double e_max = p.stage_travel * ratio / (1.0 + ratio);
  double e = motion.wafer * ratio / (1.0 + ratio);
  for (int k = 0; k < 50 && p.softening != 0.0; ++k) {
    const double force = e - 0.5 * p.softening * e * e / e_max;
    const double slope = 1.0 - p.softening * e / e_max;
    e -= (force - ratio * (motion.wafer - e)) / (slope + ratio);
  }
  motion.pipette = motion.wafer - e;
  const double t = static_cast<double>(frame) / frames_of(p);
  motion.drift = p.drift * Point(t + 0.2 * std::sin(9.0 * t), 0.6 * t - 0.15 * std::sin(7.0 * t));
  return motion;
}

GreyImage phantom_frame(const Phantom& p, int frame) {
  GreyImage image(p.width, p.height, kBackground);
  if (p.dropped == frame) return GreyImage(p.width, p.height, 0.0);
  const Layout l = layout(p);
  const PhantomMotion motion = phantom_motion(p, frame);
  const Point free_shift = motion.drift + motion.pipette * l.pull,
              fixed_shift = motion.drift + motion.wafer * l.pull;
  const Point free_bead = l.free_bead + free_shift, fixed_bead = l.fixed_bead + fixed_shift;
  const Point pipette = l.pipette + free_shift;
  Painter paint(image, p.blur);
  const double half_neck = 0.5 * p.neck_diameter, big = 4.0 * p.width;
  const double middle = 0.5 * (free_bead.y() + fixed_bead.y());
  paint.rectangle({free_bead.x(), middle - half_neck}, {fixed_bead.x(), middle + half_neck}, 0.40);
  paint.rectangle({pipette.x() - 4.0, -big}, {pipette.x() + 4.0, pipette.y() + 8.0}, 0.30);
  paint.rectangle(pipette - Point(0.0, 3.0), free_bead + Point(-0.8 * l.radius, 3.0), 0.30);
  paint.rectangle({fixed_bead.x() + l.radius - 1.0, -big}, {big, big}, 0.35);
  paint.bead(fixed_bead, l.radius);
  paint.bead(free_bead, l.radius);
  paint.speckles(free_bead, 0.85 * l.radius, p.texture, 60, random_bits(p.seed, 1));
  paint.speckles(fixed_bead, 0.85 * l.radius, p.texture, 60, random_bits(p.seed, 2));
  paint.speckles(pipette, 7.0, p.texture, 16, random_bits(p.seed, 3));
  // Dirt on the window: it rests.
  paint.speckles(l.reference + motion.drift, 10.0, 1.5 * p.texture, 40, random_bits(p.seed, 4));
  expose(image, p, frame);
  return image;
}

Calibration phantom_calibration(const Phantom& p) {
  const Layout l = layout(p);
  Calibration c;
  c.metres_per_pixel = 1e-6 * p.um_per_pixel;
  c.metres_per_pixel_sigma = 0.01 * c.metres_per_pixel;
  c.frame_rate = p.frame_rate;
  c.pipette_stiffness = p.pipette_stiffness;
  c.pipette_stiffness_sigma = 0.05 * p.pipette_stiffness;
  c.stage_speed = c.metres_per_pixel * p.stage_travel / p.loading * p.frame_rate;
  c.direction = p.direction;
  c.pull = l.pull;
  const double half = l.radius + 2.0;
  c.bead_free = around(l.free_bead, half, half);
  c.bead_fixed = around(l.fixed_bead, half, half);
  c.pipette = around(l.pipette, 9.0, 12.0);
  c.reference = around(l.reference, 15.0, 12.0);
  c.expected_diameter = p.bead_diameter * c.metres_per_pixel;
  return c;
}

void write_phantom(const fs::path& folder, const Phantom& phantom) {
  for (int frame = 0; frame < frames_of(phantom); ++frame) {
    const GreyImage image = phantom_frame(phantom, frame);
    cv::Mat picture(image.height, image.width, phantom.bits > 8 ? CV_16U : CV_8U);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (phantom.bits > 8)
          picture.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(std::lround(65535.0 * image.at(x, y)));
        else
          picture.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(255.0 * image.at(x, y)));
    write_picture(folder / fmt::format("frame_{:04d}.png", frame), picture);
  }
}

}  // namespace pendular::pipette
