#include "dem_core/linear/linear_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "dem_core/linear/joints.h"
#include "dem_core/observe/lateral_strain.h"

namespace pendular::dem_core {
namespace {

// The answer is doubted beyond these (docs/linear_response.md).
constexpr double kEffect = 0.01, kBreakingShare = 1e-3;
constexpr int kFewestOnPlaten = 3;

/// The search ends where no more than this share of the closed contacts changes: the last few go round in
/// circles, each closing opens its neighbour, and the modulus does not notice.
constexpr double kUnsettledShare = 2e-3;

// Residuals over the load. The search only has to tell open from closed.
constexpr double kSearchTolerance = 1e-5, kTolerance = 1e-8;

/// Rounds without damping, and the share of each later one that is taken; undamped many more go in circles.
constexpr int kFullRounds = 3;
constexpr double kDamping = 0.5;

constexpr Eigen::Index kAxial = 2;

Eigen::Index axial(int node) {
  return 6 * static_cast<Eigen::Index>(node) + kAxial;
}

/// A specimen, its joints and their present closures.
struct Problem {
  const Simulation& simulation;
  std::vector<Joint> joints;
  SpringNetwork nodes;
  std::vector<Closure> closures;
  NodeVector x;  ///< displacement at which the closures are
};

Problem problem_of(const Simulation& simulation, double reach) {
  Problem problem{simulation, joints_of(simulation, reach), nodes_of(simulation), {}, {}};
  problem.x = NodeVector::Zero(6 * problem.nodes.nodes());
  problem.closures = closures_at(problem.nodes, problem.joints, problem.x);
  return problem;
}

void require_path(const SpringNetwork& network) {
  if (!network.spans())
    throw ComputationFailed(
        "linear response: found no path of bonds and contacts from platen to platen, expected at least one");
}

bool settled(int unsettled, int closed) {
  return unsettled <= kUnsettledShare * closed;
}

int closed_of(const std::vector<Closure>& closures) {
  return static_cast<int>(
      std::count_if(closures.begin(), closures.end(), [](const Closure& c) { return c.closed; }));
}

int changes(const std::vector<Closure>& a, const std::vector<Closure>& b) {
  int count = 0;
  for (std::size_t k = 0; k < a.size(); ++k) count += a[k].closed != b[k].closed;
  return count;
}

/// Finds displacement and closures at a platen strain.
void find_closures(Problem& problem, double strain, int most_rounds, LinearResponse& response) {
  const double travel = strain * problem.simulation.initial_height;
  // First guess: the specimen stays whole and moves half as far as the platen, so that both ends press alike.
  for (int k = 0; k < problem.nodes.free_nodes(); ++k) problem.x[axial(k)] = 0.5 * travel;
  problem.x[axial(problem.nodes.bottom())] = travel;
  problem.closures = closures_at(problem.nodes, problem.joints, problem.x);
  NodeVector product;
  do {
    stop_if_interrupted();
    const SpringNetwork network = network_of(problem.simulation, problem.joints, problem.closures, true);
    require_path(network);
    const NodeVector load = network.pushes();
    NodeVector x = problem.x;
    response.iterations += solve(network, load, kSearchTolerance, x).iterations;
    network.multiply(x, product);
    response.stress = (product - load)[axial(network.bottom())] / problem.simulation.section;
    problem.x += (response.rounds < kFullRounds ? 1.0 : kDamping) * (x - problem.x);
    auto closures = closures_at(problem.nodes, problem.joints, problem.x);
    response.unsettled = changes(problem.closures, closures);
    problem.closures = std::move(closures);
  } while (++response.rounds < most_rounds && !settled(response.unsettled, closed_of(problem.closures)));
}

void count_contacts(const Problem& problem, const std::vector<JointState>& states, ContactCount& count) {
  for (std::size_t k = 0; k < states.size(); ++k) {
    const Joint& joint = problem.joints[k];
    if (problem.closures[k].closed) {
      const int other = joint.place.j;
      ++(other == problem.nodes.bottom() ? count.bottom
         : other == problem.nodes.top()  ? count.top
                                         : count.touching);
    }
    count.bonds += joint.bonded();
    count.sliding += states[k].slides;
    count.breaking += states[k].breaks;
  }
}

/// First-order changes of the modulus: minus the energy of what goes, over that of the whole, in the
/// displacement u of the solved problem (its energy is stationary, so the change of u does not matter).
void estimate_effects(const Problem& problem, const std::vector<JointState>& states, const NodeVector& u,
                      double energy, LinearResponse& response) {
  const LawParameters& law = problem.simulation.law;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const NetworkSpring& place = problem.joints[k].place;
    if (states[k].slides) {
      const Vec3 moved = problem.nodes.relative(place, u);
      const Vec3 sheared = moved - moved.dot(place.n) * place.n;
      const double stiffness = problem.closures[k].closed ? law.kt_glass : problem.joints[k].law.kt;
      response.sliding_effect -= 0.5 * stiffness * sheared.squaredNorm() / energy;
    }
    if (place.j >= problem.nodes.free_nodes()) continue;  // a platen's force does not turn
    const Vec3 moved = u.segment<3>(6 * place.i) - u.segment<3>(6 * place.j);
    const Vec3 across = moved - moved.dot(place.n) * place.n;
    response.load_effect -=
        0.5 * states[k].normal / problem.joints[k].distance * across.squaredNorm() / energy;
  }
}

/// Displacement for the platens' unit strain.
NodeVector unit_strain(const Problem& problem, const SpringNetwork& network, LinearResponse& response) {
  const Simulation& s = problem.simulation;
  NodeVector u = NodeVector::Zero(6 * network.nodes());
  const double share = s.initial_height / (s.top.z - s.bottom.z);
  for (int k = 0; k < network.free_nodes(); ++k) u[axial(k)] = share * (s.top.z - s.beads.position[k].z());
  u[axial(network.bottom())] = s.initial_height;
  const Solution solution = solve(network, NodeVector::Zero(u.size()), kTolerance, u);
  response.iterations += solution.iterations;
  response.residual = solution.residual;
  return u;
}

double lateral_change(const Simulation& simulation, const NodeVector& u) {
  Simulation moved = simulation;
  for (std::size_t k = 0; k < moved.beads.size(); ++k)
    moved.beads.position[k] += u.segment<3>(6 * static_cast<Eigen::Index>(k));
  return lateral_strain(moved) - lateral_strain(simulation);
}

void solve_tangent(const Problem& problem, LinearResponse& response) {
  const Simulation& s = problem.simulation;
  const SpringNetwork network = network_of(s, problem.joints, problem.closures, false);
  require_path(network);
  const NodeVector u = unit_strain(problem, network, response);
  NodeVector product;
  network.multiply(u, product);
  const double energy = 0.5 * u.dot(product);
  response.modulus = 2.0 * energy / (s.section * s.initial_height);
  response.poisson_ratio = lateral_change(s, u);
  std::vector<JointState> states;
  for (std::size_t k = 0; k < problem.joints.size(); ++k) {
    const bool acts = problem.closures[k].closed || problem.joints[k].bonded();
    states.push_back(acts ? state_at(problem.joints[k], problem.closures[k], problem.nodes, s.law, problem.x)
                          : JointState{});
  }
  count_contacts(problem, states, response.contacts);
  estimate_effects(problem, states, u, energy, response);
}

std::vector<std::string> reasons_of(const LinearResponse& r) {
  std::vector<std::string> reasons;
  const ContactCount& c = r.contacts;
  if (-r.sliding_effect > kEffect)
    reasons.push_back(fmt::format(
        "{} of {} bonds and closed contacts would slide, which takes {:.1f} % or more from the modulus",
        c.sliding, c.bonds + c.closed(), -100.0 * r.sliding_effect));
  if (std::fabs(r.load_effect) > kEffect)
    reasons.push_back(
        fmt::format("the forces carried turn with their pairs, which changes the modulus by about {:+.1f} %",
                    100.0 * r.load_effect));
  if (c.breaking > kBreakingShare * c.bonds)
    reasons.push_back(fmt::format("{} of {} bonds would break", c.breaking, c.bonds));
  if (!settled(r.unsettled, c.closed()))
    reasons.push_back(fmt::format("{} of {} closed contacts still changed in round {} of the search",
                                  r.unsettled, c.closed(), r.rounds));
  if (std::min(c.bottom, c.top) < kFewestOnPlaten)
    reasons.push_back(
        fmt::format("{} and {} beads are on the bottom and top platen, expected at least {} on each",
                    c.bottom, c.top, kFewestOnPlaten));
  return reasons;
}

}  // namespace

SpringNetwork spring_network(const Simulation& simulation) {
  const Problem problem = problem_of(simulation, 0.0);
  return network_of(simulation, problem.joints, problem.closures, false);
}

LinearResponse linear_response(const Simulation& simulation, const LinearResponseOptions& options) {
  LinearResponse response;
  if (options.strain) {
    Simulation specimen = simulation;
    // Local strains are several times the specimen's.
    list_pairs(specimen, (0.025 + 0.5 * *options.strain) * specimen.beads.mean_diameter());
    Problem problem = problem_of(specimen, *options.strain * specimen.initial_height);
    find_closures(problem, *options.strain, options.most_rounds, response);
    solve_tangent(problem, response);
  } else {
    solve_tangent(problem_of(simulation, 0.0), response);
  }
  response.reasons = reasons_of(response);
  return response;
}

}  // namespace pendular::dem_core
