#pragma once

#include "volume/volume.h"

namespace pendular {

/// Whether a file, or one of a folder without TIFF and PNG slices, has the mark of DICOM.
bool is_dicom(const fs::path& path);

/// A DICOM file of several frames, or a folder with the slices of one series, sorted by their position.
/// Lengths are mm; unsigned 8 and 16 bit stay what they are, all else, and what is rescaled, becomes float.
/// Voxels that are not cubic are resampled to cubic ones of their shortest edge, with a warning. BadInput for
/// several series, uneven distances between slices (one is missing) and slices of several sizes.
Volume read_dicom(const fs::path& path, const ReadOptions& options);

}  // namespace pendular
