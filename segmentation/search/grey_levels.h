#pragma once

#include <vector>

#include "volume/volume.h"

namespace pendular::segmentation {

/// How often each grey value occurs: bin k covers [lowest + k·width, lowest + (k+1)·width).
struct Histogram {
  double lowest = 0.0, width = 1.0;
  std::vector<double> counts;
  double centre(std::size_t bin) const { return lowest + (static_cast<double>(bin) + 0.5) * width; }
};

/// One bin per grey value for integers, 65,536 bins from least to greatest for floats.
Histogram histogram_of(const Volume& volume);
Histogram histogram_of(std::span<const float> values);

/// The two classes of grey values that a volume is made of, and what parts them.
struct GreyLevels {
  double dark = 0.0, bright = 0.0;  ///< typical grey value of either class
  double threshold = 0.0;           ///< halfway between them: where the edge of a blurred body lies
};

/// Classes by Otsu's criterion (Otsu 1979, IEEE Trans. SMC 9), then the peak of either class, or both means
/// where one class has no peak of its own. Halfway between peaks does not depend on how much there is of each
/// class, nor on a faint third one (polymer), as Otsu's threshold does.
GreyLevels grey_levels(const Histogram& histogram);

}  // namespace pendular::segmentation
