#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "viz/bead_map.h"
#include "viz/scene.h"

// Pictures by VTK. Internal to viz.

namespace pendular::viz {

/// Views in a window of their own.
struct ScenePictures {
  virtual ~ScenePictures() = default;
  virtual Image draw(const View& view, const Frame& frame, const Stage& stage, const ColourRange& range) = 0;
};

/// VTK's rendering takes longer to load than all else of a program that draws nothing: it is in a shared
/// object of its own, loaded with the first picture. Windows open on the X connection given; it closes after
/// them.
struct Rendering {
  std::unique_ptr<ScenePictures> (*scenes)(_XDisplay* connection, PictureSize size);
  std::vector<Image> (*draw_bead_maps)(_XDisplay* connection, std::span<const BeadMap> maps,
                                       PictureSize size);
  bool (*write_png)(const fs::path& path, const Image& image, const std::string& comment);
  std::string (*thumbnail)(const fs::path& picture, int width);
};

const Rendering& rendering();

}  // namespace pendular::viz

extern "C" const pendular::viz::Rendering pendular_rendering;
