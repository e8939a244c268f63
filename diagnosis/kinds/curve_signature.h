#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pendular::diagnosis {

/// A compression test as its instrument wrote it, or as a simulation made it: in order of time, strain going
/// down where it unloads. Stress in Pa, compression positive.
struct Curve {
  std::vector<double> strain, stress;
};

/// One number that a curve comes to, so that curves can be compared. Where `logarithm` is set, values are
/// compared by their ratio and are positive; otherwise by their difference.
struct CurveFeature {
  std::string name;
  bool logarithm = false;
  double value = 0.0;
  double strain_from = 0.0, strain_to = 0.0;  ///< part of the curve that it is read from, platen strain
};

/// The features of a curve up to `last_strain`, by the paper's landmarks (toe, linear part, limit, peak), so
/// that two curves are compared at the same events and not at the same strains:
///   toe_strain         where the linear part extrapolates to zero stress
///   toe_roundness      stress there over what the linear part makes of 1 % strain (log)
///   early_modulus      slope over the first fifth of the stress at the end of the linear part (log)
///   linear_modulus     slope of the linear part (log)
///   linear_limit       strain beyond the toe where the curve falls 5 % below the line
///   peak_strain        beyond the toe
///   peak_stress        (log)
///   softening          stress 2 % of strain after the peak, over the peak (log)
///   unloading_modulus  slope of an unloading between 95 and 50 % of the stress it starts from (log)
///   residual_strain    strain beyond the toe at a tenth of that stress
///   loop_area          of unloading and reloading, over the elastic energy at its start (log)
/// Of several unloadings the later ones' names end in _2, _3 … What a curve does not show is left out.
/// Noise is taken out first by straight lines through a fiftieth of the range.
std::vector<CurveFeature> curve_features(const Curve& curve, double last_strain);

/// Rows of a curve from where its strain turns back to where it is reached again.
struct Loop {
  std::size_t top, bottom, end;
};

/// Unloadings by 0.2 % of strain or more and to a quarter of the stress or less, of turns up to
/// `last_strain`.
std::vector<Loop> loops_of(const Curve& curve, double last_strain);

/// Strains at which a curve turns back by 0.2 % of strain or more, rising.
std::vector<double> unloading_strains(const Curve& curve);

/// The noise of a curve: standard deviation of the stress about straight lines through neighbours, Pa.
double curve_noise(const Curve& curve);

}  // namespace pendular::diagnosis
