#include "dem_core/law/pair.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pendular::dem_core {
namespace {

constexpr double kRadius = 1e-4, kMass = 1e-8, kInertia = 0.4 * kMass * kRadius * kRadius;

LawParameters glass() {
  LawParameters law;
  law.k_glass = 5e4;
  law.kt_glass = 1.5e4;
  law.friction = 0.5;
  return law;
}

PairProperties bond(double rest) {
  PairProperties pair;
  pair.rest = rest;
  pair.touch = std::min(0.0, rest);
  pair.kn = 5000.0;
  pair.kt = 300.0;
  pair.break_limit = 1e30;
  return pair;
}

/// Two equal free beads, i above j, moved by leapfrog.
struct TwoBeads {
  BeadMotion i{{0, 0, kRadius}, Vec3::Zero(), Vec3::Zero(), kRadius};
  BeadMotion j{{0, 0, -kRadius}, Vec3::Zero(), Vec3::Zero(), kRadius};
  PairHistory history = {};
  PairForce force = {};

  void step(const PairProperties& pair, const LawParameters& law, double dt) {
    i.position += dt * i.velocity;
    j.position += dt * j.velocity;
    force = advance_pair(i, j, pair, law, dt, history);
    i.velocity += dt / kMass * vec3(force.force);
    j.velocity -= dt / kMass * vec3(force.force);
    i.spin += dt / kInertia * torque_on_i(force, kRadius);
    j.spin += dt / kInertia * torque_on_j(force, kRadius);
  }
  Vec3 apart() const { return i.position - j.position; }
  double gap() const { return apart().norm() - 2 * kRadius; }
  double kinetic() const {
    return 0.5 * kMass * (i.velocity.squaredNorm() + j.velocity.squaredNorm()) +
           0.5 * kInertia * (i.spin.squaredNorm() + j.spin.squaredNorm());
  }
  Vec3 angular_momentum() const {
    return kMass * (i.position.cross(i.velocity) + j.position.cross(j.velocity)) +
           kInertia * (i.spin + j.spin);
  }
};

/// Bead j at rest in the origin, i at `apart` from it with the given motion.
PairForce one_step(const Vec3& apart, const Vec3& velocity, const Vec3& spin_i, const Vec3& spin_j,
                   const PairProperties& pair, const LawParameters& law, double dt, PairHistory& history) {
  return advance_pair({apart, velocity, spin_i, kRadius}, {Vec3::Zero(), Vec3::Zero(), spin_j, kRadius}, pair,
                      law, dt, history);
}

TEST(Pair, ElasticRebound) {
  TwoBeads two;
  two.i.velocity.z() = -0.1, two.j.velocity.z() = 0.1;
  const LawParameters law = glass();
  const double period = M_PI * std::sqrt(0.5 * kMass / law.k_glass), dt = period / 2000;
  for (int k = 0; k < 2100; ++k) two.step({}, law, dt);
  EXPECT_NEAR(two.i.velocity.z(), 0.1, 1e-5);
  EXPECT_GT(two.gap(), 0.0);
}

TEST(Pair, DampedReboundHasTheClosedFormRestitution) {
  // A linear spring and dashpot that let go at zero overlap: e = exp(−π ξ/√(1−ξ²)) for ξ of critical.
  const double fraction = 0.2;
  LawParameters law = glass();
  law.damping = fraction * 2.0 * std::sqrt(law.k_glass * 0.5 * kMass);
  TwoBeads two;
  two.i.velocity.z() = -0.1, two.j.velocity.z() = 0.1;
  const double dt = M_PI * std::sqrt(0.5 * kMass / law.k_glass) / 20000;
  double damped = 0.0;
  const double before = two.kinetic();
  for (int k = 0; k < 25000; ++k) {
    two.step({}, law, dt);
    damped += two.force.damped;
  }
  const double restitution = std::exp(-M_PI * fraction / std::sqrt(1.0 - fraction * fraction));
  EXPECT_NEAR(two.i.velocity.z(), 0.1 * restitution, 1e-4);
  EXPECT_NEAR(damped, before - two.kinetic(), 1e-3 * before);
}

/// Soda-lime glass: modulus of two equal beads against each other, and F = K overlap^3/2 (Hertz 1881).
constexpr double kPlainModulus = 70e9 / (2.0 * (1.0 - 0.22 * 0.22));
const double kHertz = 4.0 / 3.0 * kPlainModulus * std::sqrt(0.5 * kRadius);

LawParameters hertz_glass() {
  LawParameters law = glass();
  law.hertz_overlap = 1e-6;
  law.k_glass = kHertz * std::sqrt(law.hertz_overlap);
  return law;
}

TEST(Pair, GlassAfterHertzHasHisForce) {
  const LawParameters law = hertz_glass();
  for (double overlap : {1e-9, 1e-7, 1e-6, 3e-6}) {
    const double expected = kHertz * std::pow(overlap, 1.5);
    EXPECT_NEAR(contact_force(-overlap, 0.0, law), expected, 1e-9 * expected);
  }
  EXPECT_EQ(contact_force(1e-7, 0.0, law), 0.0);
}

TEST(Pair, HertzianImpactLastsAsLongAsItShould) {
  // Johnson, Contact Mechanics (1985), eqs. 11.23 and 11.24: 2.94 times the largest overlap over the speed.
  const double speed = 0.02, reduced = 0.5 * kMass;
  const double overlap = std::pow(1.25 * reduced * speed * speed / kHertz, 0.4);
  const double lasts = 2.9432 * overlap / speed, dt = lasts / 20000;
  TwoBeads two;
  two.i.velocity.z() = -0.5 * speed, two.j.velocity.z() = 0.5 * speed;
  const LawParameters law = hertz_glass();
  double deepest = 0.0, time = 0.0;
  do {
    two.step({}, law, dt);
    deepest = std::max(deepest, -two.gap());
    time += dt;
  } while (two.gap() < 0.0);
  EXPECT_NEAR(deepest, overlap, 1e-3 * overlap);
  EXPECT_NEAR(time, lasts, 1e-3 * lasts);
  EXPECT_NEAR(two.i.velocity.z(), 0.5 * speed, 1e-4 * speed);
}

TEST(Pair, SlidingImpactLosesTangentialVelocityByCoulomb) {
  // While the pair slides throughout, the tangential impulse is μ times the normal one (Chung & Ooi 2011,
  // test 4 at grazing incidence): per bead Δv_t = μ Δv_n = 2 μ v_n, and the spin gained is 5/2 Δv_t / R.
  LawParameters law = glass();
  law.friction = 0.1;
  TwoBeads two;
  two.i.velocity = {0.2, 0, -0.1}, two.j.velocity = {-0.2, 0, 0.1};
  const double dt = M_PI * std::sqrt(0.5 * kMass / law.k_glass) / 20000;
  for (int k = 0; k < 21000; ++k) two.step({}, law, dt);
  const double lost = 2.0 * law.friction * 0.1;
  EXPECT_NEAR(0.2 - two.i.velocity.x(), lost, 0.03 * lost);
  EXPECT_NEAR(std::fabs(two.i.spin.y()), 2.5 * lost / kRadius, 0.03 * 2.5 * lost / kRadius);
}

TEST(Pair, BondIsASpringInTensionAndInCompression) {
  const double rest = 3e-6;
  const PairProperties pair = bond(rest);
  const LawParameters law = glass();
  for (double gap : {8e-6, 3e-6, 1e-6, 0.0, -1e-6}) {
    PairHistory history = {};
    const PairForce force = one_step(Vec3(0, 0, 2 * kRadius + gap), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                     pair, law, 1e-8, history);
    const double expected = gap > 0 ? -5000.0 * (gap - rest) : -5e4 * gap + 5000.0 * rest;
    EXPECT_NEAR(force.force.z, expected, 1e-9) << "gap " << gap;
  }
}

TEST(Pair, BondedPairOscillatesAtItsFrequency) {
  const PairProperties pair = bond(5e-6);
  const LawParameters law = glass();
  TwoBeads two;
  two.i.position.z() += 3.5e-6, two.j.position.z() -= 3.5e-6;  // stretched by 2 µm: never touches
  const double period = 2.0 * M_PI * std::sqrt(0.5 * kMass / pair.kn), dt = period / 4000;
  for (int k = 0; k < 4000; ++k) two.step(pair, law, dt);
  EXPECT_NEAR(two.gap(), 7e-6, 1e-9);
}

TEST(Pair, ShearedBondCarriesKtUpToCoulomb) {
  PairProperties pair = bond(1e-6);
  LawParameters law = glass();
  for (bool limited : {false, true}) {
    law.bond_friction_limit = limited;
    PairHistory history = {};
    const double gap = 1.5e-6, speed = 0.01, dt = 1e-7;  // stretched by 0.5 µm: |F^n| = 2.5 mN
    PairForce force = {};
    for (int k = 0; k < 10000; ++k)
      force = one_step(Vec3(0, 0, 2 * kRadius + gap), Vec3(speed, 0, 0), Vec3::Zero(), Vec3::Zero(), pair,
                       law, dt, history);
    const double spring = 300.0 * 0.01 * 1e-3, coulomb = 0.5 * 2.5e-3;
    EXPECT_NEAR(force.force.x, limited ? -coulomb : -spring, 1e-9);
  }
}

TEST(Pair, RigidRotationShearsNothing) {
  const double gap = 5e-6, omega = 300.0, dt = 1e-7;
  const PairProperties pair = bond(gap);
  LawParameters law = glass();
  PairHistory history = {};
  const Vec3 axis = Vec3(1, 2, 0.5).normalized();
  for (int k = 0; k < 20000; ++k) {
    const Vec3 apart = Eigen::AngleAxisd(omega * dt * k, axis) * Vec3(0, 0, 2 * kRadius + gap);
    one_step(apart, omega * axis.cross(apart), omega * axis, omega * axis, pair, law, dt, history);
  }
  EXPECT_LT(vec3(history.bond_slip).norm(), 1e-9 * 2 * kRadius);
}

TEST(Pair, SlipTurnsWithThePair) {
  // A sheared bond that turns as a rigid body about any axis, its normal included, keeps its shear in its own
  // frame.
  const double gap = 5e-6, omega = 300.0, dt = 1e-7;
  const PairProperties pair = bond(gap);
  LawParameters law = glass();
  law.bond_friction_limit = false;
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.3, -0.5, 0.8).normalized().eval()}) {
    PairHistory history = {};
    history.bond_slip = {1e-6, 0, 0};
    const int steps = 20000;
    for (int k = 1; k <= steps; ++k) {
      const Vec3 apart = Eigen::AngleAxisd(omega * dt * k, axis) * Vec3(0, 0, 2 * kRadius + gap);
      one_step(apart, omega * axis.cross(apart), omega * axis, omega * axis, pair, law, dt, history);
    }
    const Vec3 expected = Eigen::AngleAxisd(omega * dt * steps, axis) * Vec3(1e-6, 0, 0);
    EXPECT_LT((vec3(history.bond_slip) - expected).norm(), 2e-3 * 1e-6) << axis.transpose();
  }
}

TEST(Pair, ConservesMomentumAngularMomentumAndEnergy) {
  LawParameters law = glass();
  law.bond_friction_limit = false;
  law.friction = 1e9;  // nothing slides
  const PairProperties pair = bond(4e-6);
  TwoBeads two;
  two.i.position.z() += 3e-6, two.j.position.z() -= 3e-6;
  two.i.velocity = {0.02, 0.01, 0.0};
  two.i.spin = {50.0, -80.0, 120.0};
  const Vec3 momentum = kMass * (two.i.velocity + two.j.velocity);
  const Vec3 angular = two.angular_momentum();
  const auto stored = [&] { return pair_energy(two.apart(), 2 * kRadius, pair, two.history, law); };
  const double energy = two.kinetic() + stored();
  double worst = 0.0;
  for (int k = 0; k < 200000; ++k) {
    two.step(pair, law, 2e-9);
    worst = std::max(worst, std::fabs(two.kinetic() + stored() - energy));
  }
  EXPECT_LT((kMass * (two.i.velocity + two.j.velocity) - momentum).norm(), 1e-12 * momentum.norm());
  EXPECT_LT((two.angular_momentum() - angular).norm(), 1e-4 * angular.norm());
  EXPECT_LT(worst, 5e-3 * energy);
}

TEST(Pair, BreaksOnTheEllipse) {
  const double limit = 4e-12;  // m²
  PairProperties pair = bond(2e-6);
  pair.break_limit = limit;
  for (double angle : {0.0, 0.4, 0.9, 1.3, M_PI / 2}) {
    for (double share : {0.999, 1.001}) {
      const double stretch = share * std::sqrt(limit) * std::cos(angle);
      PairHistory history = {};
      history.bond_slip.x = share * std::sqrt(12.0 * limit) * std::sin(angle);
      EXPECT_EQ(breaks(pair.rest + stretch, pair, history, glass()), share > 1.0) << angle;
      EXPECT_EQ(breaks(pair.rest - stretch, pair, history, glass()), share > 1.0)
          << "squared as written: compression counts";
    }
  }
}

TEST(Pair, SeparateLimitsBreakInTensionOrInShear) {
  LawParameters law = glass();
  law.separate_limits = true;
  PairProperties pair = bond(2e-6);
  pair.break_limit = 1e-10;  // 10 µm of tension, 10 √12 µm of shear
  const auto broken = [&](double stretch, double shear) {
    PairHistory history = {};
    history.bond_slip = {0.6 * shear, 0.8 * shear, 0.0};
    return breaks(pair.rest + stretch, pair, history, law);
  };
  const double shear = std::sqrt(12e-10);
  EXPECT_TRUE(broken(1.001e-5, 0.0));
  EXPECT_TRUE(broken(0.0, 1.001 * shear));
  EXPECT_FALSE(broken(0.999e-5, 0.999 * shear)) << "no mixed mode";
  EXPECT_FALSE(broken(-5e-5, 0.0)) << "compression does not break";
}

TEST(Pair, NormalForceIsMinusTheDerivativeOfItsEnergy) {
  const double h = 1e-11;
  for (const LawParameters& law : {glass(), hertz_glass()})
    for (double rest : {0.0, 3e-6, -2e-6}) {
      const PairProperties pair = bond(rest);
      for (double gap : {-5e-6, -1e-6, 1e-6, 6e-6}) {
        const auto slope = [&](const auto& of) { return (of(gap + h) - of(gap - h)) / (2 * h); };
        const auto energy = [&](double at) {
          return pair_energy(Vec3(0, 0, 2 * kRadius + at), 2 * kRadius, pair, {}, law);
        };
        const auto push = [&](double at) { return normal_force(at, pair, law); };
        EXPECT_NEAR(-slope(energy), push(gap), 1e-5 * std::fabs(push(gap)) + 1e-9) << rest << ' ' << gap;
        const double stiffness = normal_stiffness(gap, pair, law);
        if (gap < pair.touch) {
          EXPECT_NEAR(-slope(push), stiffness, 1e-4 * stiffness) << rest << ' ' << gap;
        }
      }
    }
}

TEST(Pair, BreakingReleasesTheStoredEnergy) {
  const LawParameters law = glass();
  PairProperties pair = bond(2e-6);
  PairHistory history = {};
  history.bond_slip = {3e-6, 0, 0};
  const Vec3 apart(0, 0, 2 * kRadius + 5e-6);
  EXPECT_NEAR(break_bond(apart, 2 * kRadius, law, pair, history), 0.5 * 5000 * 9e-12 + 0.5 * 300 * 9e-12,
              1e-20);
  EXPECT_EQ(pair_energy(apart, 2 * kRadius, pair, history, law), 0.0);
}

TEST(Pair, BentBondOscillatesAtItsFrequencies) {
  // Two free equal beads held apart, turned against each other about the line of centres (twist) or across it
  // (bending, equal and opposite turns, so that nothing shears): θ'' = −2 (k/I) θ.
  PairProperties pair = bond(5e-6);
  pair.k_bend = 3e-7;
  pair.k_twist = 1e-7;
  LawParameters law = glass();
  law.bending = true;
  law.bond_friction_limit = false;
  for (const auto& [axis, k] : {std::pair(Vec3(0, 0, 1), 1e-7), std::pair(Vec3(1, 0, 0), 3e-7)}) {
    TwoBeads two;
    two.i.position.z() += 2.5e-6, two.j.position.z() -= 2.5e-6;
    two.i.spin = 10.0 * axis, two.j.spin = -10.0 * axis;
    const double period = 2.0 * M_PI * std::sqrt(0.5 * kInertia / k), dt = period / 4000;
    double greatest = 0.0;
    for (int step = 0; step < 4000; ++step) {
      two.step(pair, law, dt);
      greatest = std::max(greatest, vec3(two.history.turn).norm());
    }
    EXPECT_NEAR(two.i.spin.dot(axis), 10.0, 0.02);
    EXPECT_NEAR(greatest, 20.0 * period / (2.0 * M_PI), 2e-3 * greatest);
  }
}

TEST(Pair, SlippingContactLosesWhatIsPutIn) {
  // A contact dragged to and fro sideways under constant overlap: the work of the drag equals energy stored
  // and slid, step by step in the mean of the forces before and after.
  const LawParameters law = glass();
  PairHistory history = {};
  const double overlap = 1e-7, dt = 1e-7;
  double work = 0.0, slipped = 0.0, last = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double speed = 0.05 * std::cos(2.0 * M_PI * k / 1000.0);
    const PairForce force = one_step(Vec3(0, 0, 2 * kRadius - overlap), Vec3(speed, 0, 0), Vec3::Zero(),
                                     Vec3::Zero(), {}, law, dt, history);
    work -= 0.5 * (force.force.x + last) * speed * dt;
    last = force.force.x;
    slipped += force.slipped;
  }
  const double stored = 0.5 * law.kt_glass * vec3(history.contact_slip).squaredNorm();
  EXPECT_GT(slipped, 10.0 * stored);
  EXPECT_NEAR(work, stored + slipped, 1e-9 * work);
}

}  // namespace
}  // namespace pendular::dem_core
