#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run_folder/run_folder.h"
#include "viz/display.h"
#include "viz/frame.h"
#include "viz/image.h"

namespace pendular::viz {

struct ScenePictures;

/// What a picture of the specimen shows.
struct View {
  enum class Colour { displacement, shear_strain, damage, force };

  std::string name;   ///< of the file and of --view
  std::string title;  ///< in the picture
  Colour colour = Colour::displacement;
  bool half =
      false;  ///< only what lies behind the vertical plane through the axis that contains the band's dip
  bool beads = true;
  bool force_chains =
      false;  ///< pairs in a slab behind that plane which carry more than the mean compressive force
  bool broken_bonds = false;  ///< a mark where each broken bond was
  std::string caption;        ///< one sentence for a reader who sees the picture alone
};

/// Every view that there is.
const std::vector<View>& views();

/// The view of that name; BadInput that lists the names for any other.
const View& view_named(const std::string& name);

/// Where the camera stands and what it sees, the same for all frames of a run.
struct Stage {
  Vec3 centre = Vec3::Zero();                    ///< of the specimen before loading, m
  double radius = 0.0, bottom = 0.0, top = 0.0;  ///< of the specimen before loading, m
  double extent = 0.0;                           ///< horizontal reach of 98 % of the beads from the axis, m
  Vec3 dip = Vec3::UnitX();  ///< horizontal part of the band's normal, unit length; to the right
  std::optional<ShearPlane> band;
};

Stage make_stage(const Frame& first, const Frame& last, const RunResult& result);

/// Value at either end of the colour bar, in the unit that the bar shows (µm, -, share, mN).
struct ColourRange {
  double low = 0.0, high = 1.0;
};

/// 2nd to 98th percentile over what the view shows of a frame; damage and force from 0; local shear strain up
/// to the 95th percentile of the beads that still have a bond, since that of a loose bead is not the
/// specimen's.
ColourRange colour_range(const View& view, const Frame& frame, const Stage& stage);

/// Draws views of one size, of any frames: its window takes longer to make than a picture to draw. The
/// display outlives it.
class ScenePainter {
 public:
  explicit ScenePainter(const Display& display, PictureSize size = {});
  ~ScenePainter();
  ScenePainter(const ScenePainter&) = delete;
  ScenePainter& operator=(const ScenePainter&) = delete;

  /// Beads as spheres with colour bar, platens, title with strain and stress, length scale, and the trace of
  /// the shear band beside the specimen where one is known.
  Image draw(const View& view, const Frame& frame, const Stage& stage, const ColourRange& range);

 private:
  Display::Connection connection_;  ///< closed after the window
  std::unique_ptr<ScenePictures> pictures_;
};

}  // namespace pendular::viz
