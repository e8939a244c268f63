#pragma once

#include "segmentation/segment.h"

namespace pendular::segmentation {

/// Pictures by which to judge a segmentation, written into `folder` (PNG):
/// - `slice_xy_1.png` … and `slice_xz_1.png` …: slices at 1/4, 1/2 and 3/4 of the beads' extent with the
///   fitted circles (green; orange where the quality is below 0.5) and the specimen (blue);
/// - `residual_xy.png` and `residual_xz.png`: grey value less that of the fitted balls, blurred, in the
///   middle slices; mid-grey is zero, black and white are ∓ the classes' difference. Polymer, walls and
///   misfits remain;
/// - `fractional_positions.png`: histogram of the centres' position within their voxel, per axis, with the
///   ±2σ band of an even spread. Peaks tell of centres locked to the grid;
/// - `diameters.png`: mean diameter over distance from the axis and height (qa_radii.h);
/// - where bridges were looked for, `contacts.png`, `mean_residuals.png` and, after calibration,
///   `recovery.png` (qa_contacts.h).
void write_qa(const fs::path& folder, const Volume& volume, const Segmentation& segmentation);

}  // namespace pendular::segmentation
