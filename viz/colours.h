#pragma once

// Colour maps of the viz folder. Internal: knows VTK.

#include <vtkColorTransferFunction.h>
#include <vtkSmartPointer.h>

#include <span>

namespace pendular::viz {

struct Range {
  double low = 0.0, high = 1.0;
};

/// Between two quantiles of the finite values, so that a few outliers do not take the colours; widened where
/// it would be empty.
Range robust_range(std::span<const double> values, double lower = 0.02, double upper = 0.98);

/// CIELAB lightness changes evenly from end to end, so that equal steps of the value look equal; in the first
/// two in grey print as well. `rising` goes from dark to light; `alarm` from pale grey to dark red, for what
/// is zero nearly everywhere; `signed_values` from blue over nearly white to red, for ranges about zero.
/// Values that are no number are drawn grey.
enum class ColourMap { rising, alarm, signed_values };

vtkSmartPointer<vtkColorTransferFunction> colours(ColourMap map, Range range);

}  // namespace pendular::viz
