#pragma once

#include <optional>
#include <vector>

#include "base/provenance.h"
#include "kinematics/local_strain.h"
#include "kinematics/shear_band.h"
#include "tracking/match.h"
#include "tracking/registration.h"

namespace pendular::tracking {

/// How the beads of a specimen moved between two scans, in the frame of the first. Lengths in m.
struct Motion {
  double strain = 0.0;  ///< of the specimen between the scans, as stated or of its ends' beads
  Registration registration;
  std::vector<BeadMatch> matches;
  // Of each match:
  std::vector<Vec3> start, displacement;
  std::vector<double> sigma;  ///< of a component of the displacement; 0: not stated
  std::vector<bool> loose;    ///< departs from its neighbours' motion
  std::vector<kinematics::LocalStrain> local;
  std::vector<int> lost;       ///< beads of the first scan that were not found again
  std::vector<int> fresh;      ///< beads of the second scan that none of the first is
  bool still = false;          ///< displacements are no larger than their stated errors
  kinematics::ShearBand band;  ///< none where nothing moved
};

struct TrackOptions {
  std::optional<double> strain;  ///< of the specimen along z, where it is known
  MatchOptions match;
};

/// Registers the second scan (register_scans), matches beads (match_beads), and takes the frame once more
/// from those that are not loose (registration_of).
///
/// A bead is loose where it lies farther from where its neighbours lead it than a fifth of a mean diameter
/// and five times what is typical of the beads around it. Errors of displacements are those of the two
/// centres; that of the frame, which all share, is not in them. Motion is `still` where the rms displacement
/// is below 1.5 of what stated errors give, or, where none are stated, where centres are the same to 1e-9 m.
///
/// BadInput where the scans do not match.
Motion follow_beads(const std::vector<Bead>& before, const std::vector<Bead>& after,
                    const TrackOptions& options = {});

/// strain,bead_id,x_um,y_um,z_um,ux_um,uy_um,uz_um as an observation of kind `displacements` has them,
/// sigma_um where both tables state the centre's error of every bead, and
/// bead_id_after,score,shear_strain,volumetric_strain,state with state `followed` or `loose`. Lengths to
/// 1e-4 µm.
void write_motion(const fs::path& path, const std::vector<Bead>& before, const std::vector<Bead>& after,
                  const Motion& motion, const Provenance& provenance);

}  // namespace pendular::tracking
