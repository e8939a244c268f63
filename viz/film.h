#pragma once

#include <optional>
#include <vector>

#include "viz/scene.h"

namespace pendular::viz {

/// The frames of a film in their folder, and the film itself where ffmpeg could make one.
struct Film {
  std::vector<fs::path> pictures;  ///< frame_0000.png …
  std::optional<fs::path> video;   ///< H.264 in MP4
};

/// Draws every frame of a run in one view and one colour range, into `folder`/frame_0000.png …; pictures of
/// an earlier, longer film there are removed. Joins them to `folder`.mp4 by ffmpeg where that is on PATH;
/// where it is not, or fails, one line says so.
Film make_film(const Display& display, const View& view, const std::vector<fs::path>& frames,
               const Stage& stage, const ColourRange& range, const fs::path& folder,
               PictureSize size = {800, 600}, const std::string& comment = "");

}  // namespace pendular::viz
