#include "effects/compress.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "dem_core/bond_bodies.h"
#include "effects/list.h"
#include "micromechanics/stiffness.h"
#include "packing/measurement.h"

namespace pendular::effects {
namespace {

/// An effect that a sample has.
struct Active {
  const Effect* effect;
  double theta;
  Draws draws;
};

std::vector<Active> active_effects(const Sample& sample, std::uint64_t seed) {
  check_effects(sample, "sample");
  std::vector<Active> active;
  for (const auto& effect : all_effects())
    if (const auto found = sample.effects.find(effect.id); found != sample.effects.end())
      active.push_back({&effect, found->second, Draws(seed, effect.id)});
  return active;
}

void make_bodies(ActualSpecimen& specimen, const std::vector<Active>& active) {
  const auto standing = dem_core::standing_bridges(specimen.packing);
  if (specimen.sample.bridges.stiffness == StiffnessOf::one)
    specimen.believed_bodies.assign(standing.size(), micromechanics::mean_bridge(specimen.sample));
  else
    specimen.believed_bodies = dem_core::bond_bodies(specimen.packing, standing, specimen.sample);
  specimen.bodies = specimen.believed_bodies;
  for (const auto& [effect, theta, draws] : active)
    if (effect->body)
      for (std::size_t k = 0; k < standing.size(); ++k)
        effect->body(specimen.bodies[k], specimen.sample, theta, draws,
                     of_pair(standing[k].i, standing[k].j));
}

/// Bonds get the stiffness and the height of their bridges' bodies.
void change_stiffness(dem_core::Simulation& simulation, const ActualSpecimen& specimen) {
  std::vector<micromechanics::BridgeBody> both = specimen.believed_bodies;
  both.insert(both.end(), specimen.bodies.begin(), specimen.bodies.end());
  const auto stiffness =
      micromechanics::bridge_stiffnesses(both, micromechanics::polymer_of(specimen.sample)).bonds;
  const auto geometry =
      dem_core::bond_bodies(specimen.packing, dem_core::standing_bridges(specimen.packing), specimen.sample);
  for (auto& pair : simulation.pairs) {
    if (pair.bond < 0) continue;
    const auto k = static_cast<std::size_t>(pair.bond);
    const micromechanics::BondStiffness &before = stiffness[k], &after = stiffness[geometry.size() + k];
    pair.properties.kn *= after.normal / before.normal;
    pair.properties.kt *= after.tangential / before.tangential;
    const micromechanics::BridgeBody &body = geometry[k], &now = specimen.bodies[k];
    double& height = simulation.bonds[k].height;
    const double longer = now.gap - specimen.believed_bodies[k].gap;
    const double neck = std::min(now.neck_diameter, 0.99 * std::min(body.diameter_i, body.diameter_j));
    const double changed =
        micromechanics::rim_height(body.gap + longer, body.diameter_i, body.diameter_j, neck);
    pair.properties.break_limit *= changed / height;
    height = changed;
  }
}

/// All of them one after the other, each with its part of a bond's memory.
dem_core::BondEvolution evolution_of(const ActualSpecimen& specimen, const std::vector<Active>& active) {
  struct Part {
    std::function<void(const dem_core::BondMoment&)> change;
    std::function<void(std::span<const dem_core::BondMoment>)> change_all;
    std::size_t first;
  };
  std::vector<Part> parts, parts_of_all;
  dem_core::BondEvolution evolution;
  for (const auto& [effect, theta, draws] : active) {
    if (effect->evolution) parts.push_back({effect->evolution(specimen, theta), {}, evolution.memory});
    if (effect->evolution_of_all)
      parts_of_all.push_back({{}, effect->evolution_of_all(specimen, theta), evolution.memory});
    evolution.memory += effect->memory;
  }
  const auto from = [](const dem_core::BondMoment& bond, std::size_t first) {
    return dem_core::BondMoment{bond.stretch, bond.shear,      bond.height,  bond.elapsed,
                                bond.normal,  bond.properties, bond.history, bond.memory + first};
  };
  if (!parts.empty())
    evolution.change = [parts, from](const dem_core::BondMoment& bond) {
      for (const Part& part : parts) part.change(from(bond, part.first));
    };
  if (!parts_of_all.empty())
    evolution.change_all = [parts_of_all, from](std::span<const dem_core::BondMoment> bonds) {
      for (const Part& part : parts_of_all) {
        std::vector<dem_core::BondMoment> own;
        for (const dem_core::BondMoment& bond : bonds) own.push_back(from(bond, part.first));
        part.change_all(own);
      }
    };
  return evolution;
}

void prepare(dem_core::Simulation& simulation, const ActualSpecimen& specimen,
             const std::vector<Active>& active) {
  if (std::any_of(active.begin(), active.end(), [](const Active& a) { return a.effect->body; })) {
    change_stiffness(simulation, specimen);
    simulation.dt = dem_core::time_step(simulation, specimen.sample.contact.time_step_fraction);
  }
  for (const auto& [effect, theta, draws] : active)
    if (effect->simulation) effect->simulation(simulation, specimen, theta, draws);
}

}  // namespace

ActualSpecimen actual_specimen(const Packing& measured, const Sample& believed, std::uint64_t seed) {
  const auto active = active_effects(believed, seed);
  ActualSpecimen specimen{believed, believed, measured, seed, {}, {}};
  // Before effects on the measurement add to the errors that are stated.
  specimen.sample.beads.diameters = diameters_used(believed, measured.beads);
  for (const auto& [effect, theta, draws] : active)
    if (effect->sample) effect->sample(specimen.sample, theta);
  for (const auto& [effect, theta, draws] : active)
    if (effect->truth) effect->truth(specimen.packing, theta, draws);
  specimen.packing = dem_core::realise(specimen.packing, specimen.sample, seed);
  for (const auto& [effect, theta, draws] : active)
    if (effect->packing) effect->packing(specimen.packing, theta, draws);
  make_bodies(specimen, active);
  return specimen;
}

std::vector<Bead> actual_beads(std::vector<Bead> measured, const Sample& believed) {
  for (const auto& [effect, theta, draws] : active_effects(believed, 0))
    if (effect->beads) effect->beads(measured, theta);
  return measured;
}

Packing reading(const Packing& actual, const Sample& believed, std::uint64_t seed) {
  Packing packing = actual;
  auto active = active_effects(believed, seed);
  std::reverse(active.begin(), active.end());
  for (const auto& [effect, theta, draws] : active)
    if (effect->reading) effect->reading(packing, theta, draws);
  return packing;
}

dem_core::Simulation actual_simulation(const ActualSpecimen& specimen) {
  dem_core::Simulation simulation = dem_core::build_simulation(specimen.packing, specimen.sample);
  prepare(simulation, specimen, active_effects(specimen.believed, specimen.seed));
  return simulation;
}

dem_core::CompressTask task_with_effects(const Packing& measured, const Sample& believed, std::uint64_t seed,
                                         const fs::path& folder, dem_core::CompressOptions options) {
  const auto active = active_effects(believed, seed);
  const auto specimen = std::make_shared<const ActualSpecimen>(actual_specimen(measured, believed, seed));
  if (!active.empty()) {
    options.work = fmt::format("effects of seed {} on\n{}", seed, sample_text(believed));
    options.prepare = [specimen, active](dem_core::Simulation& simulation) {
      prepare(simulation, *specimen, active);
    };
    options.evolution = evolution_of(*specimen, active);
    options.read_rows = [active](std::vector<CurveRow>& rows, const dem_core::Simulation& simulation) {
      for (const auto& [effect, theta, draws] : active)
        if (effect->rows) effect->rows(rows, {simulation.section, simulation.initial_height}, theta);
    };
  }
  return {specimen->packing, specimen->sample, folder, options};
}

dem_core::CompressResult compress_with_effects(const Packing& measured, const Sample& believed,
                                               std::uint64_t seed, const fs::path& folder,
                                               dem_core::CompressOptions options) {
  return dem_core::compress(task_with_effects(measured, believed, seed, folder, std::move(options)));
}

}  // namespace pendular::effects
