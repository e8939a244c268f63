#pragma once

#include <Eigen/Core>

#include <vector>

#include "dem_core/simulation.h"
#include "diagnosis/repair/place_misfit.h"

namespace pendular::diagnosis {

/// What change of stiffness about each bead would mend the difference of fields.
struct PlaceStiffness {
  std::vector<double> change;  ///< logarithm of the factor on the springs about a bead
  std::vector<double> sigma;   ///< its standard error from stated errors, members' scatter and what is left
  double threshold = 0.0;      ///< of |change| / sigma, that one specimen in twenty exceeds anywhere by noise
  int regions = 0;             ///< in which changes are sought
  double left = 1.0;           ///< rms of what no change explains, over the noise
};

/// Linearised about the experiment: bonds and contacts are springs, closed or open as gaps at rest and
/// displacements under load say. Those are the members' mean with the measured difference added, each weighed
/// by its errors; the network is solved for it with platens at `strain`.
///
/// Stiffness changes in regions about 1.6 diameters apart, at most 200, with a Gaussian share of each bead; a
/// spring has the mean of its beads'. Sensitivities are one linear solve a region. The changes are those most
/// probable under a normal prior (correlated over 1.5 diameters, its size by the largest evidence) and noise
/// with a multivariate t a bead (four degrees of freedom), scaled up to what is left. `bead`: of each
/// followed bead in the simulation. ComputationFailed where the platens are not joined.
PlaceStiffness place_stiffness(const dem_core::Simulation& specimen, double strain,
                               const std::vector<int>& bead, const std::vector<Vec3>& simulated,
                               const MovedBeads& beads);

/// Changes of stiffness in regions, `root` times numbers that are independent and alike before they are seen.
struct Regions {
  Eigen::MatrixXd root;         ///< of the prior covariance of the changes but for its size
  Eigen::MatrixXd sensitivity;  ///< of a difference of fields (three rows a bead) to those numbers
};
/// `sensitivity`: of the difference to each change; `prior`: their covariance but for its size.
Regions regions_of(const Eigen::MatrixXd& sensitivity, const Eigen::MatrixXd& prior);

struct RegionFit {
  Eigen::VectorXd change;
  Eigen::MatrixXd covariance;  ///< of `change` by noise
  double left = 1.0;           ///< rms of what no change explains, over the noise
};
/// Of a difference of fields with this variance by noise.
RegionFit fit_regions(const Regions& regions, const Eigen::VectorXd& variance,
                      const Eigen::VectorXd& difference);

}  // namespace pendular::diagnosis
