#pragma once

#include <optional>
#include <vector>

#include "pipette/calibration.h"
#include "pipette/line_fit.h"

namespace pendular::pipette {

/// Force on the bridge over its extension, SI, one entry per frame in order. Values of frames that are not
/// used are NaN.
struct Curve {
  std::vector<long long> number;  ///< of the frame
  std::vector<double> extension;  ///< fixed bead minus free bead along the pull, m
  std::vector<double> force;      ///< k_p × deflection of the pipette, N
  std::vector<double> stage;      ///< motion of the wafer along the pull, m
  std::vector<char> used;
};

/// One direction of the motion, with its linear range.
struct Branch {
  LineFit line;                                        ///< slope in N/m
  double first_extension = 0.0, last_extension = 0.0;  ///< of the linear range, m
  std::size_t frames = 0;  ///< in the branch; line.points of them are in the range
};

/// Stiffness with its uncertainties, N/m.
struct Stiffness {
  double value = 0.0;
  double fit_sigma = 0.0, calibration_sigma = 0.0;
  double low = 0.0, high = 0.0;  ///< interval of 90 %
};

/// What a curve says.
struct CurveFit {
  std::optional<Branch> loading, unloading;
  std::optional<Stiffness> stiffness;      ///< from loading; none where it has no linear range
  Covariance errors = Covariance::Zero();  ///< of extension (m) and force (N)
  std::size_t turn = 0;                    ///< entry of the greatest motion of the wafer
};

/// Least share of a branch's extension that counts as a linear range.
inline constexpr double kLeastRange = 0.2;

/// Loading ends where the wafer has moved furthest; unloading is read backwards, so that both ranges begin at
/// rest. Both coordinates have errors, which are correlated where a track enters both. The scale of the image
/// does not enter the stiffness, since force and extension are measured with the same one: calibration_sigma
/// is the pipette's alone. The interval is Student's with Welch–Satterthwaite degrees of freedom (GUM,
/// G.4.1), because a stated sigma is itself an estimate. BadInput, with `name` for the sequence, where fewer
/// than 16 frames are used.
CurveFit fit_curve(const Curve& curve, const Calibration& calibration, const std::string& name);

}  // namespace pendular::pipette
