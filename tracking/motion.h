#pragma once

#include <vector>

#include "base/provenance.h"
#include "dem_core/local_strain.h"
#include "dem_core/shear_band.h"
#include "tracking/match.h"

namespace pendular {

/// How the matched beads of a specimen moved between two scans; columns of one length. Lengths in m.
struct Motion {
  double strain = 0.0;  ///< of the specimen between the scans
  std::vector<BeadMatch> matches;
  std::vector<Vec3> start, displacement;
  std::vector<LocalStrain> local;
  ShearBand band;
};

/// `strain`: what is stated of the whole specimen.
Motion motion_of(const std::vector<Bead>& before, const std::vector<Bead>& after,
                 std::vector<BeadMatch> matches, double strain);

/// By how much the distance between the lowest and the highest beads shrank, over what it was: of the
/// centres' 1st to 99th percentile along z, over all beads of either scan.
double shortening(const std::vector<Bead>& before, const std::vector<Bead>& after);

/// strain,bead_id,x_um,y_um,z_um,ux_um,uy_um,uz_um as an observation of kind `displacements` has them, and
/// bead_id_after,score,shear_strain,volumetric_strain. Lengths to 1e-4 µm.
void write_motion(const fs::path& path, const std::vector<Bead>& before, const std::vector<Bead>& after,
                  const Motion& motion, const Provenance& provenance);

}  // namespace pendular
