#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "packing/packing.h"
#include "tracking/match.h"

namespace pendular::tracking {

/// after = scale · rotation · before + shift. Lengths in m.
struct Similarity {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double scale = 1.0;
  Vec3 shift = Vec3::Zero();
};

/// What tells a drift of the scale from strain.
enum class ScaleSource { diameters, strain, lateral };
std::string to_string(ScaleSource source);

/// How the frame of a second scan lies in that of the first.
struct Registration {
  Similarity motion;
  double scale_sigma = 0.0;  ///< standard error of motion.scale
  ScaleSource scale_from = ScaleSource::diameters;
  double axial_stretch = 1.0;                          ///< of the specimen along z, once the scale is removed
  Eigen::Affine3d even = Eigen::Affine3d::Identity();  ///< the linear motion that is left, by least squares
  std::size_t beads = 0;                               ///< that it rests on
  double rms_residual = 0.0;       ///< length of the displacements that the similarity leaves, m
  double rms_residual_even = 0.0;  ///< that `even` leaves in turn, m
};

/// Beads of the second scan in the frame of the first: centres, diameters and standard errors.
std::vector<Bead> registered(const std::vector<Bead>& after, const Similarity& motion);

/// The frame from matched beads, which `matches` names. At least four.
///
/// Rotation: pistons do not turn the specimen's ends, while a shear band turns the beads within it, and the
/// slide along it what least squares over all beads call a rotation. So tilt is taken from the ends: with it,
/// u_z has no slope over x and y, on average of the outer tenths of the beads at either end. Twist about z is
/// that of most surroundings: each bead's (gaps below a mean diameter) have a rotation of their own, the
/// polar one of their linear motion, and these lie the most densely there, seen through a Gaussian of one
/// degree. Where fewer than twenty beads have neighbours for that, least squares over all; where ends have
/// fewer than ten beads, tilt is found as twist is.
///
/// Scale: an even stretch of the specimen and a drift of the scale move beads alike, so that centres alone do
/// not tell them apart. That of these which has the least standard error does:
///   diameters  glass does not strain: s = Σ w D_after / Σ w D_before over beads with stated errors in both
///              scans, w their inverse variances; its standard error from these and, where larger, from the
///              scatter, about σ_D √2 / (D √N). A bias of diameters that only one scan has is not in it.
///   strain     `strain` ε: s = λ_z / (1 − ε) with λ_z the stretch between the outer tenths of the beads at
///              either end; ε is taken to be that of the beads within 15 %.
///   lateral    λ_z = s (1 − ε) and λ_r = s (1 + ν ε) with ν = 0.3 ± 0.2, from uniaxial compression at
///              constant section to one at constant volume.
///
/// Shift: that with which displacements have no mean.
Registration registration_of(const std::vector<Bead>& before, const std::vector<Bead>& after,
                             const std::vector<BeadMatch>& matches,
                             std::optional<double> strain = std::nullopt);

}  // namespace pendular::tracking
