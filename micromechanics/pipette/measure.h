#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pipette/calibration.h"
#include "pipette/circles.h"
#include "pipette/curve.h"
#include "pipette/frames.h"
#include "pipette/track.h"

namespace pendular::pipette {

/// What is followed in the images.
enum Body { bead_fixed, bead_free, tip, reference };
inline constexpr std::array<const char*, 4> kBodyNames = {"bead_fixed", "bead_free", "pipette", "reference"};

/// The first frame, read: where the beads are and what will be followed.
struct Scene {
  Circle fixed, free;
  std::optional<Neck> neck;
  std::array<Template, 4> templates;
};

/// One frame of the sequence.
struct FrameRecord {
  long long number = 0;
  double time = 0.0;             ///< since the first frame, s
  std::array<Match, 4> matches;  ///< by Body
  double score = 0.0;            ///< the worst of the four
  std::string rejected;          ///< why the frame is not used; empty: it is
};

struct Measurement {
  Calibration calibration;
  Scene scene;
  std::vector<FrameRecord> frames;
  std::vector<long long> missing;  ///< numbers of frames that are not there
  Curve curve;
  CurveFit fit;
  double stage_speed = 0.0;  ///< of the wafer as seen while loading, m/s
};

/// Finds the beads (in the given regions, or anywhere), their outlines and the neck, and makes the templates:
/// of a bead its disc and a little around it, without the bridge; of the pipette and the reference the whole
/// region. BadInput, with `name` for the frame, for a region outside the image, a frame that is constant or
/// saturated, beads that are not there, a pull that does not fit the direction of the test.
Scene read_scene(const GreyImage& first, const Calibration& calibration, const std::string& name);

/// Follows a scene through further frames, one by one.
class Tracker {
 public:
  Tracker(Scene scene, const Calibration& calibration);

  /// The next frame, the first one included. Frames that are constant, saturated, copies of the one before,
  /// or match badly are rejected. BadInput where a body is lost: five bad matches in a row.
  void add(const Frame& frame);

  /// The curve and its fit. `name` stands for the sequence in messages.
  Measurement finish(const std::string& name) &&;

 private:
  std::string check(const GreyImage& image) const;
  void follow(const Frame& frame, FrameRecord& record);
  Measurement result_;
  std::array<Point, 4> last_;
  GreyImage before_;
  int bad_in_a_row_ = 0;
  std::string first_bad_;
};

/// All of it: opens the source, reads the scene, follows it, fits. Shows progress.
Measurement measure(const fs::path& frames, const Calibration& calibration);

}  // namespace pendular::pipette
