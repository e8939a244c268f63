#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis_report {

/// Points in the order of the columns they come from.
struct Trace {
  std::vector<double> x, y;
  std::vector<double> sd = {};  ///< of y; empty: not stated
};

/// A way to see the columns of an observation as one quantity over another.
struct OverlayView {
  std::string suffix;          ///< of the file's name, where a kind has more than one view
  std::string x_name, y_name;  ///< of CSV columns, with units
  std::string x_title, y_title;
  double x_scale = 1.0, y_scale = 1.0;                    ///< from CSV columns to what is drawn
  std::string residual_title;                             ///< unit of what is drawn
  std::function<Trace(const diagnosis::Columns&)> shown;  ///< what is drawn of one test
  /// What tests are compared by, one value for each x, rising; in the unit of `shown`.
  std::function<Trace(const diagnosis::Columns&)> compared;
  bool measured_as_points = false;  ///< however many there are
};

/// The views of an overlay: none for a kind that is one number.
std::vector<OverlayView> views_of(const diagnosis::Overlay& overlay);

}  // namespace pendular::diagnosis_report
