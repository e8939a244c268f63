#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "pipette/grey_image.h"

namespace pendular::pipette {

/// One picture of the sequence.
struct Frame {
  long long number = 0;  ///< from its file name, or counted; frames are taken at equal intervals of it
  std::string name;      ///< for messages
  GreyImage image;
};

/// The frames of a test in order: a video, a folder of numbered images, or a pattern of their names
/// (frame_*.png). Grey of 8 or 16 bits; colour is turned to grey. A folder's images are ordered by the last
/// number in their names, which also gives their time, so that a missing file is a missing frame.
class FrameSource {
 public:
  /// BadInput where nothing can be read, or two images have the same number.
  explicit FrameSource(const fs::path& path);
  ~FrameSource();
  FrameSource(FrameSource&&) noexcept;

  /// The next frame; none at the end. BadInput for a picture that cannot be read or has another size than the
  /// first.
  std::optional<Frame> next();

  /// How many there seem to be; 0 where the video does not say.
  std::size_t expected() const;

  /// What the frames come from: the file, or the images' folder.
  fs::path origin() const;

  /// The video, or the images in their order.
  std::vector<fs::path> files() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pendular::pipette
