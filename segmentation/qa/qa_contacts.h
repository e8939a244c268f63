#pragma once

#include <opencv2/core.hpp>

#include "segmentation/segment.h"

namespace pendular::segmentation {

/// Cuts along the axis of contacts, the two beads left and right, in three bands: twenty-four bridges from
/// the thinnest to the thickest (green), as many of the most doubtful (orange), and as many pairs without a
/// bridge by rising gap (blue), each with its probability and neck diameter.
cv::Mat contact_montage(const Volume& volume, const Segmentation& segmentation);

/// Mean over all bridges, and over all pairs without one, of the grey value less that of both fitted, blurred
/// beads, along the axis: mid-grey is zero, black and white are ∓ half the classes' difference. Without
/// polymer nothing but noise may be left; what is left about the beads' edges there is what the fit does not
/// know of the picture.
cv::Mat mean_residuals(const Volume& volume, const Segmentation& segmentation);

/// Share of the necks put into the picture that were found, over their diameter.
cv::Mat recovery_curve(const std::vector<InjectedNecks>& injected);

}  // namespace pendular::segmentation
