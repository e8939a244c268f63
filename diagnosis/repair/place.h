#pragma once

#include <cstdint>
#include <string>

#include "diagnosis/repair/place_misfit.h"
#include "diagnosis/repair/place_stiffness.h"

namespace pendular::diagnosis {

/// A scan of a specimen under load, as measured and as simulated. Displacements in m, each in a frame of its
/// own; `simulated` by members of one ensemble, in that of the platens.
struct ScannedMotion {
  double strain = 0.0;
  std::vector<std::int64_t> ids;
  std::vector<Vec3> rest, measured;
  double sigma = 0.0;  ///< of a component of `measured`
  std::vector<std::vector<Vec3>> simulated;
};

/// Where in a specimen experiment and best simulation part.
struct Place {
  std::string observation;
  double strain = 0.0;
  std::vector<std::int64_t> ids;
  std::vector<Vec3> rest;
  std::vector<double> diameter;  ///< m
  PlaceMisfit misfit;
  PlaceStiffness stiffness;
  /// Beads with a misfit above this stand out: the threshold, or a third of the largest misfit, so that what
  /// a strong flaw does to its surroundings does not count as its place.
  double cut = 0.0;
  std::string words;  ///< in a sentence

  bool stands_out(std::size_t bead) const { return misfit.value[bead] > cut; }
  std::size_t count() const;  ///< of the beads that stand out
};

/// `specimen`: as measured and believed, before its test; its beads are those of `ids_of_specimen`. At least
/// three members.
Place place_of(const ScannedMotion& scan, const dem_core::Simulation& specimen,
               const std::vector<std::int64_t>& ids_of_specimen);

}  // namespace pendular::diagnosis
