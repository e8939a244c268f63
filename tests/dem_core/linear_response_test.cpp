#include "dem_core/linear/linear_response.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "dem_core/step/stepper.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::columns;
using test::disordered;
using test::sample_a;

constexpr double kGlass = 57600.0, kBond = 5760.0;  // of sample_a, N/m

Sample sticking() {
  Sample sample = sample_a();
  sample.contact.bond_friction_limit = false;
  sample.contact.friction = sample.contact.platen_friction = 10.0;
  return sample;
}

/// Disordered, but flat where it meets the platens, and with gaps of at least half a per cent of a diameter:
/// no contact opens or closes at small strains.
Packing flat_and_apart(int side, int tall) {
  Packing packing = disordered(side, tall);
  double lowest = packing.beads[0].centre.z(), highest = lowest;
  for (const auto& bead : packing.beads) {
    lowest = std::min(lowest, bead.centre.z());
    highest = std::max(highest, bead.centre.z());
  }
  for (auto& bead : packing.beads) {
    const bool at_platen = bead.centre.z() < lowest + 1e-9 || bead.centre.z() > highest - 1e-9;
    bead.diameter = at_platen ? 0.98 * 200.9e-6 : 0.995 * bead.diameter;
  }
  packing.bridges = candidate_bridges(packing.beads, 0.064 * 200.9e-6);
  return packing;
}

/// A specimen with closed glass contacts that carry next to no force, bending bonds, and both platens in
/// touch: a place where the law is linear.
Simulation closed_at_rest() {
  Simulation simulation = build_simulation(flat_and_apart(2, 2), sticking());
  const double overlap = 1e-11;
  for (std::size_t k = 0; k < simulation.pairs.size(); ++k) {
    auto& pair = simulation.pairs[k].properties;
    pair.k_bend = 2e-6;
    pair.k_twist = 1e-6;
    if (k % 3 == 0) pair.rest = pair.touch = gap(simulation, simulation.pairs[k]) + overlap;
  }
  simulation.law.bending = true;
  simulation.law.friction = simulation.law.platen_friction = 1e9;
  simulation.law.damping = 0.0;
  simulation.bottom.z += overlap;
  simulation.top.z -= overlap;
  return simulation;
}

/// K, column by column.
Eigen::MatrixXd matrix_of(const SpringNetwork& network) {
  const Eigen::Index size = 6 * network.nodes();
  Eigen::MatrixXd matrix(size, size);
  NodeVector column;
  for (Eigen::Index k = 0; k < size; ++k) {
    network.multiply(NodeVector::Unit(size, k), column);
    matrix.col(k) = column;
  }
  return matrix;
}

/// Force and torque over the radius on every bead, by the DEM's own law, after the beads have moved by x in
/// one step.
NodeVector law_forces(Simulation s, const NodeVector& x) {
  auto& beads = s.beads;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    const auto at = 6 * static_cast<Eigen::Index>(k);
    beads.position[k] += x.segment<3>(at);
    beads.velocity[k] = x.segment<3>(at) / s.dt;
    beads.spin[k] = x.segment<3>(at + 3) / beads.radius[k] / s.dt;
  }
  s.bottom.velocity = 0.0;
  NodeVector out = NodeVector::Zero(x.size());
  const auto add = [&](std::size_t bead, const Vec3& force, const Vec3& torque) {
    out.segment<3>(6 * static_cast<Eigen::Index>(bead)) += force;
    out.segment<3>(6 * static_cast<Eigen::Index>(bead) + 3) += torque / beads.radius[bead];
  };
  for (auto& pair : s.pairs) {
    const std::size_t i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
    const PairForce f =
        advance_pair(beads.motion(i), beads.motion(j), pair.properties, s.law, s.dt, pair.history);
    add(i, vec3(f.force), torque_on_i(f, beads.radius[i]));
    add(j, -vec3(f.force), torque_on_j(f, beads.radius[j]));
  }
  for (Platen* platen : {&s.bottom, &s.top})
    for (std::size_t k = 0; k < beads.size(); ++k) {
      const PlatenForce f = touch_platen(*platen, k, beads.motion(k), s.law, s.dt);
      add(k, f.force, f.torque);
    }
  return out;
}

TEST(SpringNetwork, IsTheDerivativeOfTheLaw) {
  const Simulation simulation = closed_at_rest();
  const Eigen::MatrixXd matrix = matrix_of(spring_network(simulation));
  const Eigen::Index free = matrix.rows() - 12;
  const double step = 1e-13, largest = matrix.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < free; ++k) {
    const NodeVector move = step * NodeVector::Unit(matrix.rows(), k);
    const NodeVector change = (law_forces(simulation, -move) - law_forces(simulation, move)) / (2.0 * step);
    EXPECT_LT((change - matrix.col(k)).head(free).cwiseAbs().maxCoeff(), 1e-5 * largest) << k;
  }
}

TEST(SpringNetwork, IsSymmetricAndNeverNegative) {
  const Eigen::MatrixXd matrix = matrix_of(spring_network(closed_at_rest()));
  const double largest = matrix.cwiseAbs().maxCoeff();
  EXPECT_LT((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 1e-12 * largest);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-10 * largest);
}

TEST(SpringNetwork, ResistsNoRigidMotion) {
  const Simulation simulation = closed_at_rest();
  const SpringNetwork whole = spring_network(simulation);
  auto springs = whole.springs();
  std::erase_if(springs, [&](const NetworkSpring& s) { return s.j >= whole.free_nodes(); });
  const SpringNetwork loose = whole.with(springs);
  const Vec3 shift(1e-6, -2e-6, 3e-6), turn(1e-3, 2e-3, -4e-3);
  NodeVector x = NodeVector::Zero(6 * loose.nodes()), force;
  for (int k = 0; k < loose.free_nodes(); ++k) {
    x.segment<3>(6 * k) = shift + turn.cross(simulation.beads.position[k]);
    x.segment<3>(6 * k + 3) = simulation.beads.radius[k] * turn;
  }
  loose.multiply(x, force);
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-12 * kGlass * x.cwiseAbs().maxCoeff());
  x[2] += 1e-6;
  loose.multiply(x, force);
  EXPECT_GT(force.cwiseAbs().maxCoeff(), 1e-3) << "one bead alone does meet resistance";
}

TEST(LinearResponse, ColumnsAreSpringsInSeries) {
  const Simulation simulation = build_simulation(columns(3, 6, 0.03), sticking());
  const LinearResponse response = linear_response(simulation, {1e-4});
  const double column = 1.0 / (2.0 / kGlass + 5.0 / kBond);
  const double modulus = 9.0 * column * simulation.initial_height / simulation.section;
  EXPECT_NEAR(response.modulus, modulus, 1e-9 * modulus);
  EXPECT_NEAR(response.stress, 1e-4 * modulus, 1e-6 * modulus * 1e-4);
  EXPECT_NEAR(response.poisson_ratio, 0.0, 1e-6) << "a square grid of columns does not widen";
  EXPECT_EQ(response.contacts.bottom, 9);
  EXPECT_EQ(response.contacts.top, 9);
  EXPECT_EQ(response.contacts.touching, 0);
  EXPECT_TRUE(response.holds());
}

TEST(LinearResponse, GlassTakesOverWhereAGapIsClosed) {
  // Two beads and a gap g between two platens: travel w = 2 F/k_glass + g + overlap, F = kn g + k_glass
  // overlap.
  const Simulation simulation = build_simulation(columns(2, 2, 0.01), sticking());
  const double g = 0.01 * 200.9e-6, strain = 0.02, travel = strain * simulation.initial_height;
  const double force = 4.0 * (kBond * g + kGlass * (travel - g)) / 3.0;
  const LinearResponse response = linear_response(simulation, {strain});
  const double modulus = 4.0 * kGlass / 3.0 * simulation.initial_height / simulation.section;
  EXPECT_NEAR(response.stress, force / simulation.section, 1e-4 * response.stress);
  EXPECT_NEAR(response.modulus, modulus, 1e-9 * modulus);
  EXPECT_EQ(response.contacts.touching, 4);
}

TEST(LinearResponse, FollowsHertzianGlass) {
  // As above, F = kn travel of the pair + K overlap^3/2 between the beads and K o^3/2 at each platen.
  Sample sample = sticking();
  sample.contact.glass = Glass::hertz;
  const Simulation simulation = build_simulation(columns(2, 2, 0.0), sample);
  const double strain = 0.01, travel = strain * simulation.initial_height;
  const double k = kGlass / std::sqrt(0.005 * sample.beads.diameter);
  double low = 0.0, high = travel;
  for (int step = 0; step < 60; ++step) {
    const double p = 0.5 * (low + high), force = k * std::pow(p, 1.5) + kBond * p;
    (2.0 * std::pow(force / k, 2.0 / 3.0) + p < travel ? low : high) = p;
  }
  const double force = k * std::pow(low, 1.5) + kBond * low, o = std::pow(force / k, 2.0 / 3.0);
  const double stiffness = 1.0 / (2.0 / (1.5 * k * std::sqrt(o)) + 1.0 / (1.5 * k * std::sqrt(low) + kBond));
  const LinearResponse response = linear_response(simulation, {strain});
  const double modulus = 4.0 * stiffness * simulation.initial_height / simulation.section;
  EXPECT_NEAR(response.stress, 4.0 * force / simulation.section, 1e-3 * response.stress);
  EXPECT_NEAR(response.modulus, modulus, 1e-3 * modulus);
}

TEST(LinearResponse, AgreesWithADenseDirectSolve) {
  const Simulation simulation = closed_at_rest();
  const SpringNetwork network = spring_network(simulation);
  const Eigen::MatrixXd matrix = matrix_of(network);
  const Eigen::Index free = 6 * network.free_nodes(), pushed = 6 * network.bottom() + 2;
  const Eigen::VectorXd load = -matrix.col(pushed).head(free);
  const Eigen::VectorXd u = matrix.topLeftCorner(free, free).completeOrthogonalDecomposition().solve(load);
  const double stiffness = matrix(pushed, pushed) + matrix.row(pushed).head(free).dot(u);
  const double modulus = stiffness * simulation.initial_height / simulation.section;
  EXPECT_NEAR(linear_response(simulation).modulus, modulus, 1e-8 * modulus);
}

TEST(LinearResponse, IsWhatTheDemComesToAtRest) {
  Sample sample = sticking();
  sample.contact.damping_fraction = 0.5;
  Simulation simulation = build_simulation(flat_and_apart(3, 3), sample);
  const double strain = 1e-5;
  const LinearResponse response = linear_response(simulation, {strain});
  EXPECT_TRUE(response.holds());
  simulation.bottom.velocity = 1e-4;  // ten times faster, waves lift beads off the platens and shear is lost
  Stepper stepper(simulation);
  while (simulation.strain() < strain) stepper.step();
  simulation.bottom.velocity = 0.0;
  for (int k = 0; k < 20000; ++k) stepper.step();
  const double stress = simulation.top.force / simulation.section;
  EXPECT_NEAR(stress / simulation.strain(), response.modulus, 1e-4 * response.modulus);
  EXPECT_NEAR(simulation.bottom.force, simulation.top.force, 1e-5 * simulation.top.force) << "not at rest";
}

TEST(LinearResponse, DoesNotDependOnTheNumberOfThreads) {
  const Simulation simulation = build_simulation(disordered(6, 6), sample_a());
  set_threads(1);
  const LinearResponse one = linear_response(simulation, {0.01});
  set_threads(2);
  const LinearResponse two = linear_response(simulation, {0.01});
  set_threads(0);
  EXPECT_EQ(one.modulus, two.modulus);
  EXPECT_EQ(one.poisson_ratio, two.poisson_ratio);
  EXPECT_EQ(one.stress, two.stress);
  EXPECT_EQ(one.iterations, two.iterations);
  EXPECT_GT(one.contacts.touching, 0);
}

TEST(LinearResponse, LooseBeadsChangeNothing) {
  Packing packing = flat_and_apart(2, 2);
  const double alone = linear_response(build_simulation(packing, sticking()), {1e-5}).modulus;
  Bead loose = packing.beads[5];
  loose.centre += Vec3(5e-3, 0.0, 0.0);
  packing.beads.push_back(loose);
  const double with_loose = linear_response(build_simulation(packing, sticking()), {1e-5}).modulus;
  EXPECT_NEAR(with_loose, alone, 1e-8 * alone);
}

TEST(LinearResponse, NamesWhatWouldSlide) {
  Sample sample = sticking();
  const LinearResponse sticks = linear_response(build_simulation(flat_and_apart(3, 3), sample), {1e-5});
  EXPECT_EQ(sticks.contacts.sliding, 0);
  sample.contact.platen_friction = 1e-4;
  const LinearResponse slides = linear_response(build_simulation(flat_and_apart(3, 3), sample), {1e-5});
  EXPECT_GT(slides.contacts.sliding, 0);
  EXPECT_LT(slides.sliding_effect, 0.0);
}

TEST(LinearResponse, NamesBondsThatWouldBreak) {
  Sample sample = sticking();
  sample.bridges.interfacial_energy = 1e-6;
  const LinearResponse response = linear_response(build_simulation(flat_and_apart(2, 2), sample), {1e-3});
  EXPECT_GT(response.contacts.breaking, 0);
  EXPECT_FALSE(response.holds());
  EXPECT_TRUE(std::any_of(response.reasons.begin(), response.reasons.end(), [](const std::string& reason) {
    return reason.find("would break") != std::string::npos;
  }));
}

TEST(LinearResponse, FailsWhereNothingLeadsFromPlatenToPlaten) {
  Packing packing = columns(2, 6, 0.05);
  const double middle = 0.5 * (packing.beads.front().centre.z() + packing.beads.back().centre.z());
  std::erase_if(packing.bridges, [&](const Bridge& bridge) {
    return (packing.beads[bridge.i].centre.z() < middle) != (packing.beads[bridge.j].centre.z() < middle);
  });
  const Simulation simulation = build_simulation(packing, sticking());
  EXPECT_THROW(linear_response(simulation, {1e-4}), ComputationFailed);
}

}  // namespace
}  // namespace pendular::dem_core
