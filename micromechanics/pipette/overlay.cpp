#include "pipette/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "pipette/codecs.h"

namespace pendular::pipette {
namespace {

const cv::Scalar kBlue(190, 110, 20), kOrange(0, 120, 240), kGreen(60, 150, 20), kGrey(130, 130, 130),
    kRed(30, 30, 200);
const std::array<cv::Scalar, 4> kColours = {kBlue, kOrange, kGreen, kGrey};
constexpr int kStrip = 34;  // pixels below a picture, for words
constexpr int kShift = 4;   // OpenCV draws at sixteenths of a pixel

/// A grey picture enlarged to at least about 800 pixels, to draw on.
class Sheet {
 public:
  explicit Sheet(const GreyImage& image) {
    scale_ = std::max(1, static_cast<int>(std::ceil(800.0 / image.width)));
    cv::Mat grey(image.height, image.width, CV_8U);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        grey.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(255.0 * image.at(x, y)));
    cv::resize(grey, grey, {}, scale_, scale_, cv::INTER_NEAREST);
    cv::copyMakeBorder(grey, grey, 0, kStrip, 0, 0, cv::BORDER_CONSTANT, cv::Scalar::all(255));
    cv::cvtColor(grey, picture_, cv::COLOR_GRAY2BGR);
  }

  void circle(const Point& centre, double radius, const cv::Scalar& colour) {
    cv::circle(picture_, at(centre), fixed(radius * scale_), colour, 2, cv::LINE_AA, kShift);
  }
  void line(const Point& a, const Point& b, const cv::Scalar& colour, int width = 2) {
    cv::line(picture_, at(a), at(b), colour, width, cv::LINE_AA, kShift);
  }
  void box(const Region& r, const Point& shift, const cv::Scalar& colour) {
    const Point a = Point(r.x - 0.5, r.y - 0.5) + shift, b = a + Point(r.width, r.height);
    cv::rectangle(picture_, at(a), at(b), colour, 2, cv::LINE_AA, kShift);
  }
  /// In the strip below the picture.
  void text(const std::string& words) {
    cv::putText(picture_, words, {10, picture_.rows - 11}, cv::FONT_HERSHEY_SIMPLEX, 0.6, cv::Scalar::all(20),
                1, cv::LINE_AA);
  }
  const cv::Mat& picture() const { return picture_; }

 private:
  static int fixed(double v) { return static_cast<int>(std::lround(v * (1 << kShift))); }
  cv::Point at(const Point& p) const {
    return {fixed((p.x() + 0.5) * scale_ - 0.5), fixed((p.y() + 0.5) * scale_ - 0.5)};
  }
  int scale_ = 1;
  cv::Mat picture_;
};

Point start_of(const Measurement& m, std::size_t body) {
  if (body == bead_fixed) return m.scene.fixed.centre;
  if (body == bead_free) return m.scene.free.centre;
  return m.scene.templates[body].box.centre();
}

bool shown(const Measurement& m, std::size_t body) {
  return body != tip || m.calibration.pipette.has_value();
}

/// Outlines where they were found in a frame, and the way there.
void draw_frame(Sheet& sheet, const Measurement& m, std::size_t index) {
  const FrameRecord& frame = m.frames[index];
  for (std::size_t body = 0; body < 4; ++body) {
    if (!shown(m, body)) continue;
    const Point start = start_of(m, body);
    Point before = start;
    for (std::size_t k = 1; k <= index; ++k) {
      if (!m.frames[k].rejected.empty()) continue;
      const Point now = start + m.frames[k].matches[body].displacement;
      sheet.line(before, now, kColours[body]);
      before = now;
    }
    if (!frame.rejected.empty()) continue;
    const Point shift = frame.matches[body].displacement;
    if (body == bead_fixed)
      sheet.circle(start + shift, m.scene.fixed.radius, kColours[body]);
    else if (body == bead_free)
      sheet.circle(start + shift, m.scene.free.radius, kColours[body]);
    else
      sheet.box(m.scene.templates[body].box, shift, kColours[body]);
  }
  if (!frame.rejected.empty()) {
    sheet.text("rejected: " + frame.rejected);
    return;
  }
  sheet.text(fmt::format("t = {:.2f} s, extension {:.2f} um, force {:.3f} mN, score {:.3f}", frame.time,
                         1e6 * m.curve.extension[index], 1e3 * m.curve.force[index], frame.score));
}

}  // namespace

void write_check_pictures(const fs::path& folder, const fs::path& frames, const Measurement& m) {
  FrameSource source(frames);
  cv::Mat first;
  for (std::size_t k = 0; auto frame = source.next(); ++k) {
    if (k == 0) {
      Sheet scene(frame->image);
      for (const Point& p : m.scene.fixed.edge) scene.circle(p, 0.3, kBlue);
      for (const Point& p : m.scene.free.edge) scene.circle(p, 0.3, kOrange);
      if (m.scene.neck) scene.line(m.scene.neck->a, m.scene.neck->b, kRed);
      if (m.calibration.pipette) scene.box(m.scene.templates[tip].box, Point::Zero(), kGreen);
      scene.box(m.scene.templates[reference].box, Point::Zero(), kGrey);
      const double um = 1e6 * m.calibration.metres_per_pixel;
      scene.text(fmt::format("fixed bead {:.1f} um, free bead {:.1f} um, neck {:.1f} um",
                             2.0 * um * m.scene.fixed.radius, 2.0 * um * m.scene.free.radius,
                             m.scene.neck ? um * m.scene.neck->diameter : NAN));
      write_picture(folder / "scene.png", scene.picture());
      Sheet start(frame->image);
      draw_frame(start, m, 0);
      first = start.picture();
    }
    if (k != m.fit.turn) continue;
    Sheet turn(frame->image);
    draw_frame(turn, m, k);
    cv::Mat both;
    cv::hconcat(first, turn.picture(), both);
    write_picture(folder / "tracks.png", both);
    return;
  }
}

void write_film(const fs::path& film, const fs::path& frames, const Measurement& m) {
  write_atomically(film, [&](const fs::path& temporary) {
    FrameSource source(frames);
    std::unique_ptr<VideoWriter> writer;
    Progress progress("film", static_cast<double>(m.frames.size()));
    for (std::size_t k = 0; auto frame = source.next(); ++k) {
      stop_if_interrupted();
      Sheet sheet(frame->image);
      draw_frame(sheet, m, k);
      const cv::Size even(sheet.picture().cols / 2 * 2, sheet.picture().rows / 2 * 2);
      if (k == 0)
        writer = codecs().create(temporary.string(), std::clamp(m.calibration.frame_rate, 1.0, 60.0), even);
      if (!writer)
        throw ComputationFailed(fmt::format("{}: no encoder for this kind of video", film.string()));
      writer->write(sheet.picture()(cv::Rect({0, 0}, even)));
      progress.update(static_cast<double>(k + 1));
    }
  });
}

}  // namespace pendular::pipette
