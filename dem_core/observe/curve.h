#pragma once

#include <optional>
#include <vector>

#include "run_folder/curve.h"

namespace pendular::dem_core {

/// What is read off a curve, as the paper does it.
struct CurveFeatures {
  double modulus = 0.0,
         modulus_sigma = 0.0;           ///< least-squares slope of the linear part and its standard error, Pa
  double fit_from = 0.0, fit_to = 0.0;  ///< strain range of that fit, platen strain
  double toe_strain = 0.0;              ///< platen strain where the linear part extrapolates to zero stress
  std::optional<double> linear_limit;   ///< strain beyond the toe where stress falls 5 % below the line
  double peak_strain = 0.0;             ///< beyond the toe
  double peak_stress = 0.0;             ///< Pa
  bool peak_passed = false;             ///< the curve falls below 95 % of its peak afterwards
};

/// Finds the linear part of the loading branch: the steepest window of a quarter of the strain at the peak,
/// grown to both sides while the least-squares line stays within 1 % of the peak stress. Rows of unloading
/// and reloading are left out. Nothing where the curve has fewer than eight loading rows or never rises.
std::optional<CurveFeatures> curve_features(const std::vector<CurveRow>& rows);

}  // namespace pendular::dem_core
