#pragma once

#include <string>
#include <vector>

#include "base/sample.h"
#include "packing/packing.h"

namespace pendular {

/// Whether it is known how well these beads were measured: some of them have standard errors.
bool states_errors(const std::vector<Bead>& beads);

/// What beads.diameters of the sample comes to: measured or drawn. automatic is measured where errors are
/// stated, for only these tell which beads touch.
Diameters diameters_used(const Sample& sample, bool errors_stated);
Diameters diameters_used(const Sample& sample, const std::vector<Bead>& beads);

/// The packing that beads make in the sample's specimen, with its candidate bridges. Measured diameters are
/// used with contacts closed (closed_contacts()); beads whose diameters are drawn stay where they were
/// measured.
Packing packing_of(std::vector<Bead> beads, const Sample& sample);

/// Warns where diameters are used as measured but contacts are as errors of measurement have left them:
/// packed with diameters to be drawn, or by a version that closed none.
void warn_of_open_contacts(const std::vector<Bead>& beads, const Sample& sample);

/// What closing their contacts did to measured beads.
struct Closing {
  std::size_t contacts = 0;      ///< pairs that touch now
  double centre_rms = 0.0;       ///< by which centres were moved, along each axis, m
  double diameter_rms = 0.0;     ///< by which diameters were changed, m
  double rms_over_errors = 0.0;  ///< of both, in stated standard errors
};
Closing closing(const std::vector<Bead>& measured, const std::vector<Bead>& closed);

}  // namespace pendular
