#include "dem_core/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "dem_core/bond_bodies.h"
#include "micromechanics/bridge_body.h"
#include "micromechanics/stiffness.h"
#include "packing/neighbours.h"

namespace pendular::dem_core {
namespace {

// Margins of a listing: what a bead at its present speed, or at this share of a neighbour's, which may hit
// it, moves in so many steps, between two shares of the mean diameter. The least one leaves room for beads
// that tremble, the largest keeps lists short.
constexpr double kStepsBetweenListings = 1600.0, kOfNeighbour = 0.5, kLeastMargin = 0.002,
                 kLargestMargin = 0.3;

constexpr double kHertzOverlap = 0.005;  // over D, where both laws of glass push alike

double ball_mass(double density, double diameter) {
  return density * M_PI / 6.0 * diameter * diameter * diameter;
}

BeadStates bead_states(const Packing& packing, double density) {
  BeadStates states;
  for (const auto& bead : packing.beads) {
    const double radius = 0.5 * bead.diameter, mass = ball_mass(density, bead.diameter);
    states.position.push_back(bead.centre);
    states.radius.push_back(radius);
    states.mass.push_back(mass);
    states.inertia.push_back(0.4 * mass * radius * radius);
  }
  states.start = states.position;
  states.velocity.assign(states.size(), Vec3::Zero());
  states.spin.assign(states.size(), Vec3::Zero());
  return states;
}

LawParameters law_parameters(const Sample& sample, const micromechanics::BondStiffness& bond) {
  LawParameters law;
  law.k_glass = sample.contact.stiffness_ratio * bond.normal;
  law.kt_glass = sample.contact.stiffness_ratio * bond.tangential;
  law.friction = sample.contact.friction;
  law.platen_friction = sample.contact.platen_friction;
  const double mean_mass = ball_mass(sample.beads.density, sample.beads.diameter);
  // Critical damping of two mean beads in touch: 2 √(k m/2).
  law.damping = sample.contact.damping_fraction * 2.0 * std::sqrt(law.k_glass * 0.5 * mean_mass);
  if (sample.contact.glass == Glass::hertz) law.hertz_overlap = kHertzOverlap * sample.beads.diameter;
  law.separate_limits = sample.bridges.breaking == Breaking::limits;
  law.one_spring = sample.contact.tangential_springs == TangentialSprings::one;
  law.bond_friction_limit = sample.contact.bond_friction_limit;
  return law;
}

PairProperties bond_properties(const micromechanics::BridgeBody& body, double height,
                               const micromechanics::BondStiffness& stiffness, const Sample& sample) {
  PairProperties pair;
  pair.rest = body.gap;
  pair.touch = std::min(0.0, pair.rest);
  pair.kn = stiffness.normal;
  pair.kt = stiffness.tangential;
  pair.break_limit = 2.0 * sample.bridges.interfacial_energy * height / sample.bridges.youngs_modulus;
  return pair;
}

void add_bonds(Simulation& simulation, const Packing& packing, const Sample& sample) {
  const auto standing = standing_bridges(packing);
  const auto bodies = bond_bodies(packing, standing, sample);
  const auto stiffness = micromechanics::bond_stiffnesses(sample, bodies);
  for (std::size_t k = 0; k < standing.size(); ++k) {
    Pair pair;
    pair.i = standing[k].i;
    pair.j = standing[k].j;
    pair.bond = static_cast<int>(k);
    const micromechanics::BridgeBody& body = bodies[k];
    const double height =
        micromechanics::rim_height(body.gap, body.diameter_i, body.diameter_j, body.neck_diameter);
    pair.properties = bond_properties(body, height, stiffness[k], sample);
    simulation.bonds.push_back({pair.i, pair.j, false, height});
    simulation.pairs.push_back(pair);
  }
}

/// Unbonded pairs that overlap in the measured packing: their overlap is measurement, not load.
void add_overlapping_pairs(Simulation& simulation, const Packing& packing) {
  std::vector<double> diameters;
  for (double radius : simulation.beads.radius) diameters.push_back(2.0 * radius);
  std::vector<Pair> unbonded;
  for (const auto& [i, j] : pairs_within(simulation.beads.position, diameters, 0.0)) {
    const auto place =
        std::lower_bound(simulation.pairs.begin(), simulation.pairs.end(), IndexPair(i, j),
                         [](const Pair& p, const IndexPair& q) { return IndexPair(p.i, p.j) < q; });
    if (place != simulation.pairs.end() && place->i == i && place->j == j) continue;
    Pair pair;
    pair.i = i;
    pair.j = j;
    pair.properties.rest = pair.properties.touch = std::min(0.0, gap(packing.beads[i], packing.beads[j]));
    unbonded.push_back(pair);
  }
  simulation.pairs.insert(simulation.pairs.end(), unbonded.begin(), unbonded.end());
}

void sort_pairs(std::vector<Pair>& pairs) {
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b) { return IndexPair(a.i, a.j) < IndexPair(b.i, b.j); });
}

/// Of a body at this speed.
double margin(double speed, double dt, double diameter, double least) {
  return std::max(least, std::clamp(kStepsBetweenListings * dt * speed, kLeastMargin * diameter,
                                    kLargestMargin * diameter));
}

/// Of each bead, with what it may take over from those it is paired with.
std::vector<double> speeds_to_come(const Simulation& simulation) {
  std::vector<double> own;
  for (const auto& velocity : simulation.beads.velocity) own.push_back(velocity.norm());
  std::vector<double> speed = own;
  for (const auto& pair : simulation.pairs) {
    speed[pair.i] = std::max(speed[pair.i], kOfNeighbour * own[pair.j]);
    speed[pair.j] = std::max(speed[pair.j], kOfNeighbour * own[pair.i]);
  }
  return speed;
}

Listing listing_of(const Simulation& simulation, double least) {
  const auto& beads = simulation.beads;
  const double diameter = beads.mean_diameter();
  Listing listing;
  for (const auto& place : beads.position) listing.at.push_back(place.cast<float>().cast<double>());
  for (const double speed : speeds_to_come(simulation))
    listing.margin.push_back(margin(speed, simulation.dt, diameter, least));
  listing.bottom_at = simulation.bottom.z;
  listing.top_at = simulation.top.z;
  const double speed = std::max(std::fabs(simulation.bottom.velocity), std::fabs(simulation.top.velocity));
  listing.platen_margin = margin(speed, simulation.dt, diameter, least);
  return listing;
}

int first_of(const Pair& pair) {
  return pair.i;
}
int first_of(const IndexPair& pair) {
  return pair.first;
}

/// Of sorted pairs those whose first bead is one of these.
template <typename P>
std::span<const P> pairs_of(const std::vector<P>& pairs, std::size_t first, std::size_t last) {
  const auto before = [](const P& pair, std::size_t bead) {
    return static_cast<std::size_t>(first_of(pair)) < bead;
  };
  const auto begin = std::lower_bound(pairs.begin(), pairs.end(), first, before);
  return {begin, std::lower_bound(begin, pairs.end(), last, before)};
}

/// Pairs that are near, with what the old list knows of them. Of the old list a pair drops out where it is
/// neither bonded nor near; one whose glass touches only after an initial overlap (touch < 0), or whose
/// damping is not booked yet as its bond has just broken, is remembered whatever its distance.
std::vector<Pair> with_old(std::span<const IndexPair> near, std::span<const Pair> old) {
  std::vector<Pair> listed;
  listed.reserve(near.size() + near.size() / 8);
  auto next = old.begin();
  const auto keep_old_before = [&](const IndexPair& limit) {
    for (; next != old.end() && IndexPair(next->i, next->j) < limit; ++next)
      if (next->bond >= 0 || next->properties.touch < 0.0 || next->history.closing != 0.0)
        listed.push_back(*next);
  };
  for (const auto& [i, j] : near) {
    keep_old_before({i, j});
    if (next != old.end() && next->i == i && next->j == j) {
      listed.push_back(*next++);
    } else {
      Pair pair;
      pair.i = i;
      pair.j = j;
      listed.push_back(pair);
    }
  }
  keep_old_before({std::numeric_limits<int>::max(), 0});
  return listed;
}

/// N/m.
double stiffest_spring(const Simulation& simulation) {
  double stiffest = simulation.law.k_glass;
  for (const auto& pair : simulation.pairs) stiffest = std::max(stiffest, pair.properties.kn);
  return stiffest;
}

}  // namespace

double BeadStates::mean_diameter() const {
  return 2.0 * std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(size());
}

double platen_speed(const Sample& sample) {
  if (sample.compression.speed_si) return *sample.compression.speed_si;
  const double k_glass = sample.contact.stiffness_ratio * micromechanics::bond_stiffness(sample).normal;
  return sample.compression.speed * sample.beads.diameter *
         std::sqrt(k_glass / ball_mass(sample.beads.density, sample.beads.diameter));
}

void place_platens(Simulation& simulation, double speed) {
  const auto& beads = simulation.beads;
  Platen &bottom = simulation.bottom, &top = simulation.top;
  bottom.z = std::numeric_limits<double>::infinity(), top.z = -bottom.z;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    bottom.z = std::min(bottom.z, beads.position[k].z() - beads.radius[k] + bottom.relief[k]);
    top.z = std::max(top.z, beads.position[k].z() + beads.radius[k] - top.relief[k]);
  }
  bottom.velocity = speed;
  for (Platen* platen : {&bottom, &top}) {
    platen->slip.assign(beads.size(), Vec3::Zero());
    platen->closing.assign(beads.size(), 0.0);
    platen->force = 0.0;
  }
  simulation.initial_height = top.z - bottom.z;
}

double time_step(const Simulation& simulation, double fraction) {
  const double lightest = *std::min_element(simulation.beads.mass.begin(), simulation.beads.mass.end());
  return fraction * std::sqrt(lightest / stiffest_spring(simulation));
}

Simulation build_simulation(const Packing& packing, const Sample& sample) {
  if (packing.beads.size() < 2)
    bad_input("packing: found {} bead(s), expected at least two", packing.beads.size());
  const micromechanics::BondStiffness stiffness = micromechanics::bond_stiffness(sample);
  Simulation simulation;
  simulation.beads = bead_states(packing, sample.beads.density);
  simulation.law = law_parameters(sample, stiffness);
  add_bonds(simulation, packing, sample);
  if (simulation.bonds.empty()) bad_input("packing: found no bridge, expected at least one to compress");
  sort_pairs(simulation.pairs);
  add_overlapping_pairs(simulation, packing);
  sort_pairs(simulation.pairs);
  simulation.top.normal_sign = -1.0;
  simulation.bottom.relief = simulation.top.relief = std::vector<double>(simulation.beads.size(), 0.0);
  place_platens(simulation, platen_speed(sample));
  simulation.section = 0.25 * M_PI * sample.specimen.diameter * sample.specimen.diameter;
  simulation.dt = time_step(simulation, sample.contact.time_step_fraction);
  simulation.stiffest = stiffest_spring(simulation);
  list_pairs(simulation);
  return simulation;
}

void list_pairs(Simulation& simulation, double least) {
  const auto& beads = simulation.beads;
  simulation.listing = listing_of(simulation, least);
  std::vector<double> reach;
  for (std::size_t k = 0; k < beads.size(); ++k)
    reach.push_back(2.0 * (beads.radius[k] + simulation.listing.margin[k]));
  const auto near = pairs_within(simulation.listing.at, reach, 0.0);
  constexpr std::size_t kBeadsPerTask = 512;
  std::vector<std::vector<Pair>> parts((beads.size() + kBeadsPerTask - 1) / kBeadsPerTask);
  for_blocks(beads.size(), kBeadsPerTask, [&](std::size_t first, std::size_t last) {
    parts[first / kBeadsPerTask] =
        with_old(pairs_of(near, first, last), pairs_of(std::as_const(simulation.pairs), first, last));
  });
  std::vector<std::size_t> begin(parts.size() + 1, 0);
  for (std::size_t k = 0; k < parts.size(); ++k) begin[k + 1] = begin[k] + parts[k].size();
  simulation.pairs.resize(begin.back());
  for_blocks(parts.size(), 1, [&](std::size_t k, std::size_t) {
    std::copy(parts[k].begin(), parts[k].end(),
              simulation.pairs.begin() + static_cast<std::ptrdiff_t>(begin[k]));
  });
}

Energies energies(const Simulation& simulation) {
  const auto& beads = simulation.beads;
  Energies total;
  for (std::size_t k = 0; k < beads.size(); ++k)
    total.kinetic += 0.5 * (beads.mass[k] * beads.velocity[k].squaredNorm() +
                            beads.inertia[k] * beads.spin[k].squaredNorm());
  for (const auto& pair : simulation.pairs) {
    total.elastic += pair_energy(apart(simulation, pair), beads.radius[pair.i] + beads.radius[pair.j],
                                 pair.properties, pair.history, simulation.law);
  }
  for (const Platen* platen : {&simulation.bottom, &simulation.top})
    for (std::size_t k = 0; k < beads.size(); ++k) {
      const double overlap = -platen->gap(k, beads.position[k].z(), beads.radius[k]);
      if (overlap > 0.0)
        total.elastic += contact_energy(-overlap, 0.0, simulation.law) +
                         0.5 * simulation.law.kt_glass * platen->slip[k].squaredNorm();
    }
  return total;
}

void break_bond(Simulation& simulation, Pair& pair) {
  const auto& beads = simulation.beads;
  BreakEvent event;
  event.strain = simulation.strain();
  event.i = pair.i;
  event.j = pair.j;
  event.place = 0.5 * (beads.position[pair.i] + beads.position[pair.j]);
  event.stretch = gap(simulation, pair) - pair.properties.rest;
  event.shear = length(pair.history.bond_slip);
  event.energy = break_bond(apart(simulation, pair), beads.radius[pair.i] + beads.radius[pair.j],
                            simulation.law, pair.properties, pair.history);
  simulation.work.broken += event.energy;
  simulation.bonds[pair.bond].broken = true;
  pair.bond = -1;
  simulation.events.push_back(event);
}

void advance_platens(Simulation& simulation) {
  Platen &bottom = simulation.bottom, &top = simulation.top;
  simulation.work.platen += simulation.dt * (bottom.force * bottom.velocity - top.force * top.velocity);
  for (Platen* platen : {&bottom, &top}) platen->z += simulation.dt * platen->velocity;
  ++simulation.steps;
}

BeadContacts bead_contacts(const Simulation& simulation) {
  const auto& beads = simulation.beads;
  BeadContacts count{std::vector<int>(beads.size()), std::vector<int>(beads.size())};
  for (const auto& pair : simulation.pairs) {
    if (pair.bond >= 0) ++count.bonds[pair.i], ++count.bonds[pair.j];
    if (gap(simulation, pair) <= pair.properties.touch) ++count.touching[pair.i], ++count.touching[pair.j];
  }
  return count;
}

}  // namespace pendular::dem_core
