#pragma once

#include <Eigen/Core>
#include <vector>

#include "dem_core/step/forces.h"

namespace pendular::dem_core {

/// Stress, Pa; compression positive.
using Stress = Eigen::Matrix3d;

/// Coarse-grained contact stress at each of `points` (Goldhirsch 2010, Granular Matter 12, 239; Weinhart et
/// al. 2012, as MercuryDPM does): Σ f ⊗ b ∫₀¹ φ(x − s b) ds over all pairs and platen contacts, with b from
/// centre to centre (or from platen to centre) and f the force along it, made symmetric. φ is Lucy's kernel
/// with cut-off `reach` (m), whose integral over space is 1; the line integral is Gauss's with two points.
/// The kinetic part is left out. Within `reach` of a surface the kernel also covers space outside the
/// specimen, which carries nothing. The same for any number of threads.
std::vector<Stress> stress_field(const Simulation& simulation, const Forces& forces,
                                 const std::vector<Vec3>& points, double reach);

/// Of the specimen's frames: one and a half mean diameters, m.
double stress_field_reach(const Simulation& simulation);

/// A third of the trace.
double pressure(const Stress& stress);

/// √(3/2 s:s) of the deviator s (von Mises).
double deviatoric_stress(const Stress& stress);

}  // namespace pendular::dem_core
