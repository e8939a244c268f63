#include "dem_core/observe/frame_observers.h"

#include "dem_core/observe/stress_field.h"
#include "dem_core/step/forces.h"
#include "kinematics/local_strain.h"

namespace pendular::dem_core {
namespace {

void add_local_strain(const Simulation& simulation, const std::vector<Link>&, PolyTable& frame) {
  const auto& beads = simulation.beads;
  std::vector<double> shear, volumetric;
  for (const auto& strain : kinematics::local_strains(beads.start, beads.position, beads.radius)) {
    shear.push_back(strain.shear);
    volumetric.push_back(strain.volumetric);
  }
  frame.point_data.emplace_back("local_shear_strain", shear);
  frame.point_data.emplace_back("local_volumetric_strain", volumetric);
}

void add_local_stress(const Simulation& simulation, const std::vector<Link>&, PolyTable& frame) {
  std::vector<double> mean, deviatoric;
  for (const auto& stress : stress_field(simulation, forces(simulation), simulation.beads.position,
                                         stress_field_reach(simulation))) {
    mean.push_back(pressure(stress));
    deviatoric.push_back(deviatoric_stress(stress));
  }
  frame.point_data.emplace_back("pressure_pa", mean);
  frame.point_data.emplace_back("deviatoric_stress_pa", deviatoric);
}

void add_coordination(const Simulation& simulation, const std::vector<Link>&, PolyTable& frame) {
  const BeadContacts count = bead_contacts(simulation);
  frame.point_data.emplace_back("coordination",
                                std::vector<std::int64_t>(count.bonds.begin(), count.bonds.end()));
  frame.point_data.emplace_back("touching",
                                std::vector<std::int64_t>(count.touching.begin(), count.touching.end()));
}

/// Share of a bead's bonds that have broken.
void add_damage(const Simulation& simulation, const std::vector<Link>&, PolyTable& frame) {
  std::vector<double> broken(simulation.beads.size()), all(simulation.beads.size());
  for (const auto& bond : simulation.bonds)
    for (int bead : {bond.i, bond.j}) {
      all[bead] += 1.0;
      if (bond.broken) broken[bead] += 1.0;
    }
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k] > 0.0) broken[k] /= all[k];
  frame.point_data.emplace_back("damage", broken);
}

/// Normal forces, and whether a pair is of the force chains: pushes more than the mean of those that push
/// (Radjai et al. 1998, PRL 80, 61).
void add_force_chains(const Simulation&, const std::vector<Link>& links, PolyTable& frame) {
  double sum = 0.0, count = 0.0;
  std::vector<double> force;
  for (const auto& link : links) {
    force.push_back(link.normal_force);
    if (link.normal_force > 0.0) sum += link.normal_force, count += 1.0;
  }
  std::vector<std::int64_t> in_chain;
  for (double f : force) in_chain.push_back(f > 0.0 && f * count > sum);
  frame.line_data.emplace_back("normal_force_n", force);
  frame.line_data.emplace_back("force_chain", in_chain);
}

}  // namespace

std::vector<Link> links(const Simulation& simulation) {
  std::vector<Link> found;
  for (const auto& pair : simulation.pairs) {
    const double apart_by = gap(simulation, pair);
    if (pair.bond < 0 && apart_by > pair.properties.touch) continue;
    found.push_back(
        {pair.i, pair.j, pair.bond >= 0 ? 0 : 2, normal_force(apart_by, pair.properties, simulation.law)});
  }
  for (const auto& bond : simulation.bonds)
    if (bond.broken) found.push_back({bond.i, bond.j, 1, 0.0});
  return found;
}

const std::vector<FrameObserver>& frame_observers() {
  static const std::vector<FrameObserver> all = {
      {&Sample::Observe::local_strain, add_local_strain}, {&Sample::Observe::local_stress, add_local_stress},
      {&Sample::Observe::coordination, add_coordination}, {&Sample::Observe::damage, add_damage},
      {&Sample::Observe::force_chains, add_force_chains},
  };
  return all;
}

}  // namespace pendular::dem_core
