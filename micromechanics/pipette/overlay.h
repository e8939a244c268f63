#pragma once

#include "base/files.h"
#include "pipette/measure.h"

namespace pendular::pipette {

/// Pictures for judging a measurement by eye, into a folder that is there: scene.png (first frame with
/// outlines, neck and what is followed) and tracks.png (first frame and the frame of greatest motion, side by
/// side, with outlines where they were found and their tracks).
void write_check_pictures(const fs::path& folder, const fs::path& frames, const Measurement& measurement);

/// The sequence with outlines, tracks and numbers drawn on, as a video (.mp4 or .avi). ComputationFailed
/// where no encoder is to be had.
void write_film(const fs::path& film, const fs::path& frames, const Measurement& measurement);

}  // namespace pendular::pipette
