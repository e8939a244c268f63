// An outside judge: the same bonded packing, compressed by Yade (JCFpm, bench/peers/yade.py).
//
// The same in both: positions, radii, masses, inertia; kn about the pair's own rest length, kt with torques
// about mid-gap; k_glass where bonded beads touch; the dashpot along the line of centres; platens that only
// touch, with k_glass, 10 kt and Coulomb's limit; time step, leapfrog, speed. Breaking is out of reach in
// both. Not the same: how a spring across the contact is turned with it, and the arm of a platen's friction
// (in Yade to the platen, here to the middle of the overlap).
//
// So motion agrees, waves included, but for these two. Turns are of the order of the strain ε < 1e-2 and the
// two ways of turning differ by its square: 1e-4 of the shear forces, which carry some tenth of the load:
// 1e-5. The arms differ by half an overlap over a radius, 2e-3 in platen friction where that is on.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/files.h"
#include "dem_core/simulation.h"
#include "dem_core/step/stepper.h"
#include "packing/bridges.h"
#include "packing/exchange.h"
#include "packing/generate.h"
#include "places.h"
#include "program.h"
#include "scratch.h"

namespace pendular {
namespace {

constexpr int kRows = 20;

struct Curve {
  std::vector<double> strain, stress;
};

/// Sample A's law without breaking, on a specimen of a few hundred beads, at the paper's speed.
Sample small_sample() {
  Sample sample;
  sample.bridges.normal_stiffness = 5760.0;
  sample.bridges.tangential_stiffness = 325.0;
  sample.bridges.interfacial_energy = 7e6;
  sample.beads.diameters = Diameters::measured;
  sample.contact.bond_friction_limit = false;
  sample.specimen.diameter = sample.specimen.height = 1.3e-3;
  sample.specimen.volume_fraction = 0.56;
  sample.compression.speed = 1e-4;
  return sample;
}

Packing bonded(Packing packing, const Sample& sample) {
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  return packing;
}

/// Every steps_per_row steps, the mean of both platens' forces over the section.
Curve compress_here(dem_core::Simulation& simulation, int steps_per_row) {
  dem_core::Stepper stepper(simulation);
  Curve curve;
  for (int row = 0; row < kRows; ++row) {
    for (int k = 0; k < steps_per_row; ++k) stepper.step();
    curve.strain.push_back(simulation.strain());
    curve.stress.push_back(0.5 * (simulation.top.force + simulation.bottom.force) / simulation.section);
  }
  stepper.store();
  return curve;
}

void write_for_yade(const std::filesystem::path& folder, const Packing& packing,
                    const dem_core::Simulation& simulation, const Sample& sample, int steps_per_row) {
  write_exchange(folder / "beads.txt", ExchangeFormat::yade, packing, sample.beads.density);
  std::string bonds;
  for (const auto& bridge : packing.bridges) bonds += fmt::format("{} {}\n", bridge.i, bridge.j);
  write_text(folder / "bonds.txt", bonds);
  const auto& law = simulation.law;
  const nlohmann::json values = {{"kn_n_per_m", *sample.bridges.normal_stiffness},
                                 {"kt_n_per_m", *sample.bridges.tangential_stiffness},
                                 {"k_glass_n_per_m", law.k_glass},
                                 {"kt_glass_n_per_m", law.kt_glass},
                                 {"platen_friction", law.platen_friction},
                                 {"density_kg_m3", sample.beads.density},
                                 {"dashpot_n_s_per_m", law.damping},
                                 {"local_damping", 0.0},
                                 {"time_step_s", simulation.dt},
                                 {"speed_m_per_s", dem_core::platen_speed(sample)},
                                 {"steps", kRows * steps_per_row},
                                 {"steps_per_row", steps_per_row},
                                 {"compare", true},
                                 {"warm_up_steps", 0}};
  write_text(folder / "law.json", values.dump(2));
}

Curve compress_with_yade(const std::filesystem::path& folder, double section) {
  const auto run =
      test::shell(folder, "yade -j1 -n -x '" + pendular::test::source_folder() + "/bench/peers/yade.py'");
  EXPECT_EQ(run.status, 0) << run.errors;
  Curve curve;
  std::istringstream rows(test::content(folder / "curve.csv"));
  std::string line;
  std::getline(rows, line);
  while (std::getline(rows, line)) {
    double strain = 0.0, top = 0.0, bottom = 0.0;
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &strain, &top, &bottom), 3) << line;
    curve.strain.push_back(strain);
    curve.stress.push_back(0.5 * (top + bottom) / section);
  }
  return curve;
}

/// Slope of the least-squares line through the curve's upper half, Pa.
double modulus(const Curve& curve) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t k = kRows / 2; k < kRows; ++k) {
    n += 1.0;
    x += curve.strain[k];
    y += curve.stress[k];
    xx += curve.strain[k] * curve.strain[k];
    xy += curve.strain[k] * curve.stress[k];
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

double largest_difference(const Curve& a, const Curve& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < kRows; ++k) largest = std::max(largest, std::fabs(a.stress[k] - b.stress[k]));
  return largest / a.stress.back();
}

int touching_pairs(const dem_core::Simulation& simulation) {
  int touching = 0;
  for (const auto& pair : simulation.pairs) touching += gap(simulation, pair) <= pair.properties.touch;
  return touching;
}

class Yade : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v yade >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "yade is not installed (Debian: apt-get install yade)";
  }

  /// Both curves to `strain`, pendular's first, and the specimen at the end.
  struct Comparison {
    Curve here, yade;
    dem_core::Simulation end;
  };
  Comparison compare(const Packing& packing, const Sample& sample, double strain) {
    Comparison out;
    out.end = dem_core::build_simulation(packing, sample);
    const double steps = strain * out.end.initial_height / (dem_core::platen_speed(sample) * out.end.dt);
    const int steps_per_row = static_cast<int>(std::lround(steps / kRows));
    write_for_yade(scratch_.path(), packing, out.end, sample, steps_per_row);
    out.here = compress_here(out.end, steps_per_row);
    out.yade = compress_with_yade(scratch_.path(), out.end.section);
    return out;
  }

  void report(const Comparison& c) {
    const double ratio = modulus(c.yade) / modulus(c.here);
    fmt::print(
        "{} beads, {} bonds, {} touching; E {:.4g} MPa, Yade's over it less one {:.1e}; curves within "
        "{:.1e}\n",
        c.end.beads.size(), c.end.bonds.size(), touching_pairs(c.end), 1e-6 * modulus(c.here), ratio - 1.0,
        largest_difference(c.here, c.yade));
  }

 private:
  test::ScratchFolder scratch_;
};

/// Beads 3 % smaller than they were packed: bridges carry everything, no glass touches.
TEST_F(Yade, AgreesWhereBridgesCarryAll) {
  const Sample sample = small_sample();
  Packing packing = generate_packing(sample, 5);
  for (auto& bead : packing.beads) bead.diameter *= 0.97;
  const auto c = compare(bonded(packing, sample), sample, 2e-3);
  ASSERT_EQ(c.yade.stress.size(), c.here.stress.size());
  EXPECT_NEAR(c.yade.strain.back(), c.here.strain.back(), 1e-9);
  report(c);
  EXPECT_EQ(touching_pairs(c.end), 0);
  EXPECT_TRUE(c.end.events.empty());
  EXPECT_NEAR(modulus(c.yade) / modulus(c.here), 1.0, 1e-3);
  EXPECT_LT(largest_difference(c.here, c.yade), 2e-3);
}

/// Beads that close their gaps: the stiffening that sets sample A's modulus. Frictionless, since Yade's one
/// interaction per pair cannot hold the glass's own tangential spring.
TEST_F(Yade, AgreesWhereGlassTouches) {
  Sample sample = small_sample();
  sample.contact.friction = sample.contact.platen_friction = 0.0;
  const auto c = compare(bonded(generate_packing(sample, 5), sample), sample, 6e-3);
  ASSERT_EQ(c.yade.stress.size(), c.here.stress.size());
  EXPECT_NEAR(c.yade.strain.back(), c.here.strain.back(), 1e-9);
  report(c);
  EXPECT_GT(touching_pairs(c.end), static_cast<int>(c.end.bonds.size()) / 10);
  EXPECT_TRUE(c.end.events.empty());
  EXPECT_NEAR(modulus(c.yade) / modulus(c.here), 1.0, 2e-5);
  EXPECT_LT(largest_difference(c.here, c.yade), 2e-5);
}

}  // namespace
}  // namespace pendular
