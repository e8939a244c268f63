#include "dem_core/drive/run_length.h"

#include <algorithm>
#include <cmath>

#include "dem_core/simulation.h"
#include "micromechanics/stiffness.h"

namespace pendular::dem_core {

// As sample A takes, and specimens of 1,300 beads.
constexpr double kStepsPerIncrement = 1000.0;

double expected_steps(const Sample& sample) {
  const auto& asked = sample.compression;
  if (asked.control == Control::relaxation)
    return kStepsPerIncrement * asked.max_strain / asked.relax_increment;
  const double mean = sample.beads.diameter;
  const double spread = sample.beads.diameters == Diameters::measured ? sample.beads.diameter_sd / mean
                                                                      : sample.beads.realisation_sd;
  // Time step over √(m/k_glass) of a mean bead.
  const double step = sample.contact.time_step_fraction * std::pow(std::max(0.5, 1.0 - 3.0 * spread), 1.5);
  const double bead_mass = sample.beads.density * M_PI / 6.0 * mean * mean * mean;
  const auto unit_time = [&] {
    return std::sqrt(bead_mass /
                     (sample.contact.stiffness_ratio * micromechanics::bond_stiffness(sample).normal));
  };
  // The platen's way in one step; stiffness is only asked for where the sample states times or speeds in SI.
  const double way = asked.speed_si ? *asked.speed_si * step * unit_time() : asked.speed * mean * step;
  double steps = asked.max_strain * sample.specimen.height / way;
  const auto holds = static_cast<double>(asked.hold_at.size());
  if (holds > 0.0)
    steps += holds * (asked.hold_time ? *asked.hold_time / (step * unit_time())
                                      : asked.hold * sample.specimen.height / way);
  return steps;
}

}  // namespace pendular::dem_core
