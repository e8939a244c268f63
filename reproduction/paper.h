#pragma once

#include <array>

namespace pendular::reproduction {

/// What Hemmerle, Yamaguchi, Makowski, Bäumchen & Goehring 2021 state in numbers, SI.

/// A specimen of Table 1; its bridges have a gap of 2 µm and a Poisson ratio of 0.49.
struct PaperSpecimen {
  const char* name;
  double youngs_modulus, neck_diameter, bead_diameter;  ///< Pa, m, m
  double normal_stiffness, tangential_stiffness;        ///< N/m
};
inline constexpr std::array<PaperSpecimen, 2> kPaperSpecimens = {
    {{"Sample A", 1.5e6, 73.9e-6, 200.9e-6, 5760.0, 325.0},
     {"Sample B", 0.64e6, 72.1e-6, 200.9e-6, 2345.0, 131.0}}};
inline constexpr double kPaperGap = 2e-6, kPaperPoissonRatio = 0.49;

/// The micropipette tests (Sec. 2).
struct PaperPipette {
  double youngs_modulus = 50e3, bead_diameter = 365e-6;  ///< Pa, m
  double thinnest = 50e-6, widest = 270e-6;              ///< bridge diameter, m
  double normal_low = 200.0, normal_high = 800.0;        ///< measured, N/m
  double tangential_low = 5.0, tangential_high = 30.0;   ///< measured, N/m
};
inline constexpr PaperPipette kPaperPipette;

inline constexpr double kPaperCoordination = 7.4, kPaperCutoff = 0.064;  ///< Z of interior beads; × D
inline constexpr double kPaperLinearLimit = 0.04;                        ///< strain beyond the toe
inline constexpr double kPaperPlatenSpeed = 46.4e-3;                     ///< of sample A, m/s
inline constexpr double kPaperGapEffect = 1.6;                           ///< E at a gap of 1 µm over 2 µm
inline constexpr double kPaperFunicularContent = 0.027;                  ///< W*

}  // namespace pendular::reproduction
