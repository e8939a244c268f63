#include "micromechanics/bridge_body.h"

#include <cmath>

namespace pendular::micromechanics {
namespace {

/// Height of the cap of a ball of diameter D cut by a cylinder of diameter d on its axis.
double sagitta(double ball_diameter, double neck_diameter) {
  const double radius = 0.5 * ball_diameter, rim = 0.5 * neck_diameter;
  return rim * rim / (radius + std::sqrt(radius * radius - rim * rim));
}

double cap_volume(double ball_diameter, double neck_diameter) {
  const double rim = 0.5 * neck_diameter, height = sagitta(ball_diameter, neck_diameter);
  return M_PI * height / 6.0 * (3.0 * rim * rim + height * height);
}

}  // namespace

double rim_height(double gap, double diameter_i, double diameter_j, double neck_diameter) {
  return gap + sagitta(diameter_i, neck_diameter) + sagitta(diameter_j, neck_diameter);
}

double bridge_volume(double gap, double diameter_i, double diameter_j, double neck_diameter) {
  const double section = 0.25 * M_PI * neck_diameter * neck_diameter;
  return section * rim_height(gap, diameter_i, diameter_j, neck_diameter) -
         cap_volume(diameter_i, neck_diameter) - cap_volume(diameter_j, neck_diameter);
}

}  // namespace pendular::micromechanics
