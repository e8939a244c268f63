#include "effects/effect.h"

namespace pendular::effects {
namespace {

void scale(Packing& packing, double by) {
  for (auto& bead : packing.beads) {
    bead.centre *= by;
    for (double* length : {&bead.diameter, &bead.sigma_centre, &bead.sigma_diameter}) *length *= by;
  }
  for (auto& bridge : packing.bridges)
    for (double* length : {&bridge.gap, &bridge.sigma_gap, &bridge.diameter, &bridge.sigma_diameter})
      *length *= by;
  auto& cylinder = packing.specimen;
  for (double* length :
       {&cylinder.diameter, &cylinder.height, &cylinder.axis_x, &cylinder.axis_y, &cylinder.bottom})
    *length *= by;
}

void sample(Sample& sample, double theta) {
  for (double* length : {&sample.beads.diameter, &sample.specimen.diameter, &sample.specimen.height})
    *length /= 1.0 + theta;
}

void truth(Packing& packing, double theta, const Draws&) {
  scale(packing, 1.0 / (1.0 + theta));
}

double lengths(double theta) {
  return 1.0 + theta;
}

void rows(std::vector<CurveRow>& rows, const Gauge&, double theta) {
  for (auto& row : rows) {
    row.strain /= 1.0 + theta;
    row.stress /= (1.0 + theta) * (1.0 + theta);
    row.stress_bottom /= (1.0 + theta) * (1.0 + theta);
  }
}

}  // namespace

/// The paper's lengths rest on the tomogram's voxel size. Where that is too large by the share θ, so are all
/// lengths measured with it: centres, diameters, gaps, and the specimen's height and section by which strain
/// and stress are computed. Force, platen travel and what is stated of the bridges are true. E stays with
/// stated bond stiffness: longer and wider by the same share. What it does to the peak has not been
/// measured.
Effect voxel_scale() {
  return {.id = "voxel_scale",
          .unit = "fraction",
          .name = "wrong voxel size",
          .sentence = "The voxel size of the tomogram is wrong, and all lengths with it.",
          .meaning = "relative error of the voxel size",
          .lowest = -0.2,
          .highest = 0.2,
          .bank_from = -0.05,
          .bank_to = 0.05,
          .settled_by = calibration_sphere(),
          .sample = sample,
          .truth = truth,
          .rows = rows,
          .lengths = lengths};
}

}  // namespace pendular::effects
