#include "dem_core/law/platen.h"

#include "dem_core/law/platen-inl.h"

namespace pendular::dem_core {

PlatenNumbers<double> platen_numbers(const Platen& platen, const LawParameters& law, double dt) {
  return {platen.z,         platen.velocity,     platen.normal_sign, law.k_glass, law.kt_glass,
          per_overlap(law), law.platen_friction, law.damping,        dt,          0.5 * law.damping * dt};
}

PlatenForce touch_platen(Platen& platen, std::size_t k, const BeadMotion& bead, const LawParameters& law,
                         double dt) {
  Vec3& slip = platen.slip[k];
  PlatenMemory<double> memory = {slip.x(), slip.y(), platen.closing[k]};
  const PlatenAction<double> action = HWY_NAMESPACE::touch(
      platen_numbers(platen, law, dt), parts(law),
      {bead.position.z(), bead.radius, platen.relief[k], triple(bead.velocity), triple(bead.spin)}, memory);
  slip = {memory.slip_x, memory.slip_y, 0.0};
  platen.closing[k] = memory.closing;
  return {vec3(action.force), Vec3(action.torque_x, action.torque_y, 0.0), action.normal, action.damped,
          action.slipped};
}

}  // namespace pendular::dem_core
