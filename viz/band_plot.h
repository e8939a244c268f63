#pragma once

#include <string>
#include <vector>

#include "viz/figure.h"
#include "viz/series_plot.h"

namespace pendular::viz {

/// What several realisations come to over x: a band and its middle. Where one of the values is not finite,
/// the band is interrupted.
struct Band {
  std::string label;
  std::vector<double> x, low, middle, high;  ///< of one length; x rising
  std::vector<Series> lines = {};            ///< of the realisations, drawn thin
};

/// Something measured beside bands, with a strip below that shows how far the bands are from it.
struct BandPlot {
  std::string x_title, y_title, residual_title;
  Series measured;              ///< in black
  std::vector<Band> bands;      ///< at most three
  std::vector<Band> residuals;  ///< of the bands, in their order; empty: no strip
  Band error = {};              ///< of what was measured, about zero in the strip; empty: not stated
};

Figure band_figure(const BandPlot& plot, PictureSize size = {1600, 1200});

}  // namespace pendular::viz
