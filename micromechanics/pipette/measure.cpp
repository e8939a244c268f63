#include "pipette/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"

namespace pendular::pipette {
namespace {

constexpr double kAroundBead = 1.12;       // radius followed over the bead's
constexpr double kFromBridge = 5.0;        // pixels: blurred, it reaches that far
constexpr int kLost = 5;                   // bad matches in a row
constexpr double kConstant = 2.0 / 255.0;  // sd of the grey values of a frame that shows nothing
constexpr double kSaturatedShare = 0.3;    // of a region's pixels that are black or white
constexpr double kSurely = 0.05;           // pixels: several times the error of a mean displacement
constexpr double kMostTilt = 20.0;         // degrees between the pull and what the test's direction says

struct Flatness {
  double sd = 0.0, saturated = 0.0;  ///< saturated: share of pixels that are black or white
};

Flatness flatness(const GreyImage& image, const Region& box) {
  double sum = 0.0, squares = 0.0, ends = 0.0;
  const double count = static_cast<double>(box.width) * box.height;
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) {
      const double v = image.at(x, y);
      sum += v;
      squares += v * v;
      ends += v <= 0.0 || v >= 1.0;
    }
  return {std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count))), ends / count};
}

Region box_around(const Circle& circle, const GreyImage& image) {
  const double r = kAroundBead * circle.radius;
  Region box;
  box.x = std::max(0, static_cast<int>(std::floor(circle.centre.x() - r)));
  box.y = std::max(0, static_cast<int>(std::floor(circle.centre.y() - r)));
  box.width = std::min(image.width, static_cast<int>(std::ceil(circle.centre.x() + r)) + 1) - box.x;
  box.height = std::min(image.height, static_cast<int>(std::ceil(circle.centre.y() + r)) + 1) - box.y;
  return box;
}

/// A bead without its bridge, which deforms: nothing nearer to the plane between the beads than the bridge's
/// rim.
Template bead_template(const GreyImage& image, const Circle& bead, const Circle& other,
                       double neck_diameter) {
  const Point axis = (other.centre - bead.centre).normalized();
  const double half_neck = std::min(0.5 * neck_diameter, 0.8 * bead.radius);
  const double reach = std::sqrt(bead.radius * bead.radius - half_neck * half_neck) - kFromBridge;
  return make_template(image, box_around(bead, image), [&](const Point& p) {
    const Point off = p - bead.centre;
    return off.norm() <= kAroundBead * bead.radius && off.dot(axis) <= reach;
  });
}

Circle outline_in(const GreyImage& image, const Region& region, const Region& other, Body body,
                  const std::string& name) {
  const double radius = 0.25 * (region.width + region.height) - 1.0;
  const auto circle = find_outline(image, region.centre(), radius, other.centre());
  if (!circle)
    bad_input("{}: {}: found no round outline in its region, expected a bead", name, kBodyNames[body]);
  return *circle;
}

void find_beads(Scene& scene, const GreyImage& image, const Calibration& c, const std::string& name) {
  if (c.bead_fixed) {
    scene.fixed = outline_in(image, *c.bead_fixed, *c.bead_free, bead_fixed, name);
    scene.free = outline_in(image, *c.bead_free, *c.bead_fixed, bead_free, name);
  } else {
    const auto beads = find_two_beads(image, 0.5 * c.expected_diameter / c.metres_per_pixel);
    if (!beads)
      bad_input(
          "{}: found no two touching circles of about {:.4g} um, expected two beads (or give their regions)",
          name, 1e6 * c.expected_diameter);
    const bool forward = ((*beads)[1].centre - (*beads)[0].centre).dot(c.pull) >= 0.0;
    scene.free = (*beads)[forward ? 0 : 1];
    scene.fixed = (*beads)[forward ? 1 : 0];
  }
  const Point between = scene.fixed.centre - scene.free.centre;
  if (between.norm() < std::max(scene.fixed.radius, scene.free.radius))
    bad_input("{}: found the two beads in the same place, expected them side by side", name);
  const double cosine = std::abs(between.normalized().dot(c.pull));
  const double angle = std::acos(std::min(1.0, cosine)) * 180.0 / M_PI;
  const double expected = c.direction == Direction::normal ? 0.0 : 90.0;
  if (std::abs(angle - expected) > kMostTilt)
    bad_input(
        "{}: test.pull_direction_px: found {:.0f} degrees to the line of the beads, expected {:.0f} for a {} "
        "test",
        name, angle, expected, c.direction == Direction::normal ? "normal" : "tangential");
}

void require_inside(const GreyImage& image, const Region& region, Body body, const std::string& name) {
  if (!region.within(image))
    bad_input("{}: region of {}: found [{}, {}, {}, {}], expected it within the image of {} x {} pixels",
              name, kBodyNames[body], region.x, region.y, region.width, region.height, image.width,
              image.height);
}

void check_template(const GreyImage& image, const Template& made, Body body, const std::string& name) {
  const double saturated = flatness(image, made.box).saturated;
  if (saturated > kSaturatedShare)
    bad_input("{}: {}: {:.0f} % of its pixels are saturated (black or white), expected at most {:.0f} %",
              name, kBodyNames[body], 100.0 * saturated, 100.0 * kSaturatedShare);
  if (made.norm == 0.0)
    bad_input("{}: {}: found no contrast in its region, expected a picture that can be followed both ways",
              name, kBodyNames[body]);
}

/// Speed of the wafer from its first to its last sure step of loading.
double loading_speed(const Curve& curve, const std::vector<FrameRecord>& frames, std::size_t turn) {
  const double top = std::abs(curve.stage[turn]);
  std::size_t first = turn, last = turn;
  for (std::size_t k = 0; k <= turn; ++k) {
    if (!curve.used[k]) continue;
    if (std::abs(curve.stage[k]) < 0.1 * top) first = k;
    if (std::abs(curve.stage[k]) < 0.9 * top) last = k;
  }
  const double time = frames[last].time - frames[first].time;
  return time > 0.0 ? std::abs(curve.stage[last] - curve.stage[first]) / time : 0.0;
}

/// The wafer drags both beads, and its own the further; beads that move alike are left as they are.
bool fixed_moves_least(const Measurement& m) {
  double difference = 0.0, frames = 0.0;
  for (const FrameRecord& frame : m.frames) {
    if (!frame.rejected.empty()) continue;
    const Point rest = frame.matches[reference].displacement;
    const double fixed = (frame.matches[bead_fixed].displacement - rest).dot(m.calibration.pull);
    const double free = (frame.matches[bead_free].displacement - rest).dot(m.calibration.pull);
    difference += std::abs(fixed) - std::abs(free);
    ++frames;
  }
  return difference < -kSurely * frames;
}

/// Across the pull, beads found by the program look alike until they move.
void swap_beads(Measurement& m) {
  std::swap(m.scene.fixed, m.scene.free);
  std::swap(m.scene.templates[bead_fixed], m.scene.templates[bead_free]);
  if (!m.calibration.pipette) m.scene.templates[tip] = m.scene.templates[bead_free];
  for (FrameRecord& frame : m.frames) {
    std::swap(frame.matches[bead_fixed], frame.matches[bead_free]);
    if (!m.calibration.pipette) frame.matches[tip] = frame.matches[bead_free];
  }
}

}  // namespace

Scene read_scene(const GreyImage& first, const Calibration& c, const std::string& name) {
  const Flatness whole = flatness(first, {0, 0, first.width, first.height});
  if (whole.sd < kConstant)
    bad_input("{}: found a constant picture (sd {:.2g} of full scale), expected two beads", name, whole.sd);
  if (whole.saturated > 0.6)
    bad_input("{}: {:.0f} % of the pixels are saturated (black or white), expected at most 60 %", name,
              100.0 * whole.saturated);
  if (c.bead_fixed) require_inside(first, *c.bead_fixed, bead_fixed, name);
  if (c.bead_free) require_inside(first, *c.bead_free, bead_free, name);
  if (c.pipette) require_inside(first, *c.pipette, tip, name);
  require_inside(first, c.reference, reference, name);
  Scene scene;
  find_beads(scene, first, c, name);
  scene.neck = find_neck(first, scene.free, scene.fixed);
  const double neck = scene.neck ? scene.neck->diameter : scene.free.radius;
  scene.templates[bead_fixed] = bead_template(first, scene.fixed, scene.free, neck);
  scene.templates[bead_free] = bead_template(first, scene.free, scene.fixed, neck);
  scene.templates[tip] = c.pipette ? make_template(first, *c.pipette) : scene.templates[bead_free];
  scene.templates[reference] = make_template(first, c.reference);
  for (Body body : {bead_fixed, bead_free, tip, reference})
    check_template(first, scene.templates[body], body, name);
  return scene;
}

Tracker::Tracker(Scene scene, const Calibration& calibration) {
  result_.scene = std::move(scene);
  result_.calibration = calibration;
  last_.fill(Point::Zero());
}

std::string Tracker::check(const GreyImage& image) const {
  const Flatness whole = flatness(image, {0, 0, image.width, image.height});
  if (whole.sd < kConstant) return "constant or black";
  if (whole.saturated > 0.6) return "saturated";
  if (image.values == before_.values) return "copy of the frame before";
  return "";
}

void Tracker::follow(const Frame& frame, FrameRecord& record) {
  const Calibration& c = result_.calibration;
  const bool own_tip = c.pipette.has_value();
  for_blocks(4, 1, [&](std::size_t body, std::size_t) {
    if (body != tip || own_tip)
      record.matches[body] = match(result_.scene.templates[body], frame.image, last_[body], c.search_reach);
  });
  if (!own_tip) record.matches[tip] = record.matches[bead_free];
  std::size_t worst = 0;
  for (std::size_t body = 1; body < 4; ++body)
    if (record.matches[body].score < record.matches[worst].score) worst = body;
  record.score = record.matches[worst].score;
  const bool found =
      std::all_of(record.matches.begin(), record.matches.end(), [](const Match& m) { return m.found; });
  if (record.score >= c.least_score && found) {
    bad_in_a_row_ = 0;
    for (std::size_t body = 0; body < 4; ++body) last_[body] = record.matches[body].displacement;
    return;
  }
  if (record.score >= c.least_score)
    for (std::size_t body = 0; body < 4; ++body)
      if (!record.matches[body].found) worst = body;
  record.rejected = fmt::format("{}: score {:.2f}{}", kBodyNames[worst], record.matches[worst].score,
                                record.matches[worst].found ? "" : ", no match within the image");
  if (bad_in_a_row_++ == 0) first_bad_ = fmt::format("{}: {}", frame.name, record.rejected);
  if (bad_in_a_row_ == kLost)
    bad_input("{}: lost from here on, expected at least {} (tracking.least_score, tracking.search_px)",
              first_bad_, c.least_score);
}

void Tracker::add(const Frame& frame) {
  auto& frames = result_.frames;
  FrameRecord record;
  record.number = frame.number;
  record.time = frames.empty() ? 0.0
                               : static_cast<double>(frame.number - frames.front().number) /
                                     result_.calibration.frame_rate;
  // A gap longer than the sequence so far and to come is a numbering of its own, not lost frames.
  if (!frames.empty() && frame.number - frames.back().number < 1000)
    for (long long n = frames.back().number + 1; n < frame.number; ++n) result_.missing.push_back(n);
  record.rejected = check(frame.image);
  if (record.rejected.empty()) follow(frame, record);
  frames.push_back(std::move(record));
  before_ = frame.image;
}

Measurement Tracker::finish(const std::string& name) && {
  const Calibration& c = result_.calibration;
  if (fixed_moves_least(result_)) {
    if (c.bead_fixed)
      bad_input(
          "{}: the fixed bead moves less than the free one, expected the wafer's bead to move most (regions "
          "swapped?)",
          name);
    swap_beads(result_);
  }
  Curve& curve = result_.curve;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto along = [&](const FrameRecord& frame, Body body) {
    return c.metres_per_pixel * frame.matches[body].displacement.dot(c.pull);
  };
  for (const FrameRecord& frame : result_.frames) {
    const bool used = frame.rejected.empty();
    const double rest = along(frame, reference);
    curve.number.push_back(frame.number);
    curve.used.push_back(used);
    curve.stage.push_back(used ? along(frame, bead_fixed) - rest : nan);
    curve.extension.push_back(used ? along(frame, bead_fixed) - along(frame, bead_free) : nan);
    curve.force.push_back(used ? c.pipette_stiffness * (along(frame, tip) - rest) : nan);
  }
  result_.fit = fit_curve(curve, c, name);
  result_.stage_speed = loading_speed(curve, result_.frames, result_.fit.turn);
  return std::move(result_);
}

Measurement measure(const fs::path& path, const Calibration& calibration) {
  FrameSource source(path);
  auto frame = source.next();
  if (!frame) bad_input("{}: found no frames", path.string());
  Tracker tracker(read_scene(frame->image, calibration, frame->name), calibration);
  const double total = static_cast<double>(std::max<std::size_t>(source.expected(), 1));
  Progress progress("tracking", total);
  for (std::size_t k = 1; frame; ++k, frame = source.next()) {
    stop_if_interrupted();
    tracker.add(*frame);
    progress.update(static_cast<double>(k));
  }
  return std::move(tracker).finish(path.string());
}

}  // namespace pendular::pipette
