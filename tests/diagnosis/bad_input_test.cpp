// What an experimenter may hand in by mistake: refused in one line that names the file, what was found and
// what was expected, or told as a warning, before any run is made.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "base/error.h"
#include "base/random.h"
#include "diagnosis/experiment/experiment.h"
#include "followed.h"
#include "packing/tables.h"
#include "sample_file.h"
#include "scratch.h"

namespace pendular::diagnosis {
namespace {

using pendular::test::ScratchFolder;
using test::Followed;
using test::followed_rows;
using test::followed_specimen;
using test::followed_text;

/// An experiment of one observation, `table.csv`; `keys` of it besides kind and file. `beads.csv` is beside
/// it.
Experiment read(const ScratchFolder& folder, const std::string& kind, const std::string& table,
                const std::string& keys = "") {
  write_text(folder / "sample.toml",
             pendular::test::sample_file(
                 "[beads]\ndiameter_um = 200\n[specimen]\ndiameter_um = 1300\nheight_um = 1200\n"
                 "[bridges]\nyoungs_modulus_pa = 1.5e6\ndiameter_um = 74\ngap_um = 2\n"));
  write_beads(folder / "beads.csv", followed_specimen(), {});
  write_text(folder / "table.csv", table);
  write_text(folder / "e.toml",
             fmt::format("[experiment]\nsample = \"sample.toml\"\n[[observation]]\nkind = \"{}\"\n"
                         "name = \"one\"\nfile = \"table.csv\"\n{}\n",
                         kind, keys));
  return read_experiment(folder / "e.toml");
}

struct Bad {
  std::string name, kind, table, keys;
  std::vector<std::string> told;  ///< by the message, besides the file, what was found and what was expected
};

class BadObservation : public testing::TestWithParam<Bad> {};

TEST_P(BadObservation, IsRefusedInOneLine) {
  ScratchFolder folder;
  try {
    read(folder, GetParam().kind, GetParam().table, GetParam().keys);
    FAIL() << "expected to be refused";
  } catch (const BadInput& error) {
    const std::string message = error.what();
    for (const auto& told : GetParam().told) EXPECT_NE(message.find(told), std::string::npos) << message;
    for (const char* word : {"table.csv", "found", "expected"})
      EXPECT_NE(message.find(word), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

/// Ten rows; columns by functions of the row.
std::string rows(const std::string& header, const std::function<std::string(int)>& row) {
  std::string text = header + "\n";
  for (int k = 0; k < 10; ++k) text += row(k) + "\n";
  return text;
}

std::string curve(double stress, double sigma = 0.0, bool reversed = false) {
  return rows(sigma > 0.0 ? "strain,stress_pa,stress_sigma_pa" : "strain,stress_pa", [&](int row) {
    const int k = reversed ? 10 - row : row;
    return fmt::format("{},{}", 0.008 * k, 1.5e5 * k * stress) +
           (sigma > 0.0 ? fmt::format(",{}", sigma) : "");
  });
}

std::string bridge(double d, double diameter, double kn, double sigma) {
  return fmt::format("d_um,D_um,kn_n_per_m,kn_sigma_n_per_m\n{},{},{},{}\n", d, diameter, kn, sigma);
}

/// Of bridges of 74 um on beads of 200 um at 2 um of a polymer of 1.5 MPa: kn is that of the paper's, some
/// 5,760 N/m.
std::string bridges_in(double unit) {
  return bridge(74, 200, 5760 * unit, 300 * unit);
}

std::string moved(const std::function<void(Followed&)>& change, double strain = 0.02, double unit = 1e-6,
                  double sigma = 0.1) {
  auto rows = followed_rows(followed_specimen(), strain);
  for (auto& row : rows) change(row);
  return followed_text(rows, strain, unit, sigma);
}

/// Both places and motion of the table as `map` has them: as if a scan had been reconstructed so.
std::string seen_as(const std::function<Vec3(const Vec3&)>& map) {
  return moved([&](Followed& row) {
    const Vec3 now = map(row.at + row.motion);
    row.at = map(row.at), row.motion = now - row.at;
  });
}

std::string of_other_beads() {
  auto rows = followed_rows(followed_specimen(99), 0.02);
  for (auto& row : rows) row.at *= 1.3;
  return followed_text(rows, 0.02);
}

/// Motions of these beads, but each of another one.
std::string mixed_up() {
  auto rows = followed_rows(followed_specimen(), 0.02);
  const auto original = rows;
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].motion = original[(97 * k + 13) % rows.size()].motion;
  return followed_text(rows, 0.02);
}

std::string network(int first_id, int step) {
  std::string text = "bead_i,bead_j,state\n";
  for (int k = 0; k < 60; ++k)
    text += fmt::format("{},{},{}\n", first_id + k, first_id + k + step, k % 3 ? "bridge" : "none");
  return text;
}

const std::string kBeads = "beads = \"beads.csv\"";

INSTANTIATE_TEST_SUITE_P(
    Table, BadObservation,
    testing::Values(
        Bad{"BreaksPerInterval",
            "broken_bonds",
            "strain,count\n0.01,5\n0.02,40\n0.03,12\n",
            "",
            {"12", "after 40", "per_interval"}},
        Bad{"BreaksInFallingStrain",
            "broken_bonds",
            "strain,count\n0.03,40\n0.02,12\n0.01,5\n",
            "",
            {"0.02 after 0.03", "order"}},
        Bad{"BreaksBelowZero", "broken_bonds", "strain,count\n0.01,-5\n0.02,40\n", "", {"-5"}},
        Bad{"CurveInFallingStrain", "compression", curve(1.0, 0.0, true), "", {"strain", "reversed"}},
        Bad{"CurveInMegapascals", "compression", curve(1e-6), "", {"stress_pa", "MPa"}},
        Bad{"CurveInKilopascals", "compression", curve(1e-3), "", {"stress_pa", "kPa"}},
        Bad{"CurveWithAbsurdSigma", "compression", curve(1.0, 1e12), "", {"stress_sigma_pa", "1e+12"}},
        Bad{"TravelInMicrometres",
            "compression",
            rows("strain,stress_pa", [](int k) { return fmt::format("{},{}", 10.0 * k, 1e5 * k); }),
            "",
            {"strain", "per cent", "um"}},
        Bad{"LateralInFallingStrain",
            "lateral_strain",
            rows("strain,lateral_strain",
                 [](int k) { return fmt::format("{},{}", 0.01 * (10 - k), 0.003 * (10 - k)); }),
            "",
            {"0.09 after 0.1", "order"}},
        Bad{"LateralInPerCent",
            "lateral_strain",
            rows("strain,lateral_strain", [](int k) { return fmt::format("{},{}", 0.002 * k, 0.06 * k); }),
            "",
            {"lateral_strain", "per cent"}},
        Bad{"LateralWithAbsurdSigma",
            "lateral_strain",
            rows("strain,lateral_strain,sigma",
                 [](int k) { return fmt::format("{},{},1e12", 0.01 * k, 0.003 * k); }),
            "",
            {"sigma", "1e+12"}},
        Bad{"CoordinationWithAbsurdSigma", "coordination", "z,z_sigma\n6,1e12\n", "", {"z_sigma", "1e+12"}},
        Bad{"SeriesInMegapascals",
            "modulus_series",
            "E_p_pa,modulus_pa,modulus_sigma_pa\n1.5e6,20,1\n",
            "",
            {"modulus_pa", "MPa"}},
        Bad{"SeriesOfPolymersInMegapascals",
            "modulus_series",
            "E_p_pa,modulus_pa,modulus_sigma_pa\n1.5,2e7,1e6\n3,4e7,1e6\n",
            "",
            {"E_p_pa", "MPa"}},
        Bad{"SeriesOfContentsInPerCent",
            "modulus_series",
            "W,modulus_pa,modulus_sigma_pa\n2.3,2e7,1e6\n",
            "",
            {"W", "per cent"}},
        Bad{"SeriesWithAbsurdSigma",
            "modulus_series",
            "E_p_pa,modulus_pa,modulus_sigma_pa\n1.5e6,2e7,1e12\n",
            "",
            {"modulus_sigma_pa", "1e+12"}},
        Bad{"BridgesInKilonewtonsPerMetre",
            "bridge_stiffness",
            bridges_in(1e-3),
            "",
            {"kn_n_per_m", "finite elements", "kN/m"}},
        Bad{"BridgesInMillinewtonsPerMetre",
            "bridge_stiffness",
            bridges_in(1e3),
            "",
            {"kn_n_per_m", "finite elements", "mN/m"}},
        Bad{"BridgesInNewtonsPerMicrometre",
            "bridge_stiffness",
            bridges_in(1e-6),
            "",
            {"kn_n_per_m", "finite elements", "N/um"}},
        Bad{"BridgesWithNecksInMillimetres",
            "bridge_stiffness",
            bridge(0.074, 200, 5760, 300),
            "",
            {"d_um", "mm"}},
        Bad{"BridgesInMillimetres", "bridge_stiffness", bridge(0.074, 0.2, 5760, 300), "", {"D_um", "mm"}},
        Bad{"BridgesInMetres", "bridge_stiffness", bridge(74e-6, 200e-6, 5760, 300), "", {"D_um", "in m?"}},
        Bad{"BridgesThickerThanTheirBeads",
            "bridge_stiffness",
            "d_um,D_um,kn_n_per_m,kn_sigma_n_per_m\n74,200,5760,300\n74,200,5760,300\n210,200,5760,300\n",
            "",
            {"210", "thinner"}},
        Bad{"BridgesWithAbsurdSigma",
            "bridge_stiffness",
            bridge(74, 200, 5760, 1e12),
            "",
            {"kn_sigma_n_per_m", "1e+12"}},
        Bad{"BridgesWithoutSigma",
            "bridge_stiffness",
            "d_um,D_um,kn_n_per_m\n74,200,5760\n",
            "",
            {"kn_n_per_m without kn_sigma_n_per_m"}},
        Bad{"NecksInMillimetres",
            "bridge_diameters",
            rows("d_um", [](int k) { return fmt::format("{}", 0.07 + 0.001 * k); }),
            "",
            {"d_um", "mm"}},
        Bad{"NecksWithAbsurdSigma",
            "bridge_diameters",
            rows("d_um,sigma_um", [](int k) { return fmt::format("{},1e12", 70 + k); }),
            "",
            {"sigma_um", "1e+12"}},
        Bad{"GapsInMillimetres",
            "bridge_gaps",
            rows("gap_um", [](int k) { return fmt::format("{}", 0.002 + 1e-4 * k); }),
            "",
            {"gap_um", "mm"}},
        Bad{"GapsInMetres",
            "bridge_gaps",
            rows("gap_um", [](int k) { return fmt::format("{}", 2e-6 + 1e-7 * k); }),
            "",
            {"gap_um", "in m?"}},
        Bad{"GapsWithAbsurdSigma",
            "bridge_gaps",
            rows("gap_um,sigma_um", [](int k) { return fmt::format("{},1e12", 2 + k); }),
            "",
            {"sigma_um", "1e+12"}}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Scans, BadObservation,
    testing::Values(
        Bad{"FieldAtRest", "displacements", moved([](Followed&) {}, 0.0), kBeads, {"strain"}},
        Bad{"FieldOfAnotherSpecimen",
            "displacements",
            of_other_beads(),
            kBeads,
            {"beads.csv", "another specimen"}},
        Bad{"FieldOfAnotherSpecimensMotion",
            "displacements",
            mixed_up(),
            kBeads,
            {"neighbours", "another specimen"}},
        Bad{"FieldTurned",
            "displacements",
            seen_as([](const Vec3& p) -> Vec3 {
              return {p.z(), p.y(), -p.x()};
            }),
            kBeads,
            {"turned"}},
        Bad{"FieldMirrored",
            "displacements",
            seen_as([](const Vec3& p) -> Vec3 {
              return {-p.x(), p.y(), p.z()};
            }),
            kBeads,
            {"mirrored"}},
        Bad{"MotionTurned",
            "displacements",
            moved([](Followed& row) {
              row.motion = {row.motion.z(), row.motion.y(), -row.motion.x()};
            }),
            kBeads,
            {"degrees to z", "turned"}},
        Bad{"MotionOfTheOtherSign",
            "displacements",
            moved([](Followed& row) { row.motion = -row.motion; }),
            kBeads,
            {"degrees to z", "sign"}},
        Bad{"MotionMirroredInThePlane",
            "displacements",
            moved([](Followed& row) { row.motion.z() = -row.motion.z(); }),
            kBeads,
            {"degrees to z", "mirrored"}},
        Bad{"PlacesOfTheSecondScanMirrored",
            "displacements",
            moved([](Followed& row) {
              const Vec3 now = row.at + row.motion;
              row.motion = Vec3(-now.x(), now.y(), now.z()) - row.at;
            }),
            kBeads,
            {"rigid motion", "mirrored"}},
        Bad{"MotionInMillimetres",
            "displacements",
            moved([](Followed& row) { row.motion *= 1e-3; }),
            kBeads,
            {"rigid motion", "mm"}},
        Bad{"FieldInMillimetres", "displacements", moved([](Followed&) {}, 0.02, 1e-3), kBeads, {"in mm"}},
        Bad{"FieldInMetres", "displacements", moved([](Followed&) {}, 0.02, 1.0), kBeads, {"in m?"}},
        Bad{"FieldWithOtherIds",
            "displacements",
            moved([](Followed& row) { row.id += 1000; }),
            kBeads,
            {"column bead_id", "1001", "beads.csv"}},
        Bad{"FieldWithShiftedIds",
            "displacements",
            moved([](Followed& row) { row.id = row.id % 256 + 1; }),
            kBeads,
            {"another specimen"}},
        Bad{"FieldWithABeadTwice",
            "displacements",
            moved([](Followed& row) { row.id = std::max<std::int64_t>(row.id, 2); }),
            "",
            {"twice"}},
        Bad{"FieldWithAbsurdSigma",
            "displacements",
            moved([](Followed&) {}, 0.02, 1e-6, 1e12),
            kBeads,
            {"sigma_um", "1e+12"}},
        Bad{"BridgesOfUnknownBeads", "bridges", network(240, 1), kBeads, {"bead"}},
        Bad{"BridgesOfAnotherSpecimen", "bridges", network(1, 150), kBeads, {"another specimen"}},
        Bad{"BridgesWithoutBeads", "bridges", network(1, 1), "", {"beads"}}),
    [](const auto& test) { return test.param.name; });

TEST(GoodObservation, TurnedAndShiftedAsAWholeIsNoMistake) {
  ScratchFolder folder;
  const auto turned = [](const Vec3& p) -> Vec3 { return Vec3(-p.y(), p.x(), p.z()) + Vec3(3e-5, 0, -2e-5); };
  const std::string table = moved([&](Followed& row) { row.motion = turned(row.at + row.motion) - row.at; });
  EXPECT_TRUE(read(folder, "displacements", table, kBeads).warnings.empty());
}

// Errors of places that are not stated may be larger than what neighbours move against each other.
TEST(GoodObservation, PlacesWorseThanStatedAreAWarning) {
  ScratchFolder folder;
  std::uint64_t next = 0;
  const std::string table = moved([&](Followed& row) {
    for (int axis = 0; axis < 3; ++axis) row.motion[axis] += 9e-6 * random_normal(1, next++);
  });
  const auto warnings = read(folder, "displacements", table, kBeads).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("places worse than stated"), std::string::npos) << warnings[0];
}

TEST(GoodObservation, BreaksOfEachRowAreTakenWhereThatIsSaid) {
  ScratchFolder folder;
  const auto experiment =
      read(folder, "broken_bonds", "strain,count\n0.01,5\n0.02,40\n0.03,12\n", "counts = \"per_interval\"");
  EXPECT_EQ(experiment.observations[0].column("count"), (std::vector{5.0, 45.0, 57.0}));
}

TEST(GoodObservation, BridgesOfTheRightUnitAreTaken) {
  ScratchFolder folder;
  EXPECT_TRUE(read(folder, "bridge_stiffness", bridges_in(1.0)).warnings.empty());
}

TEST(GoodObservation, BeadsThatCameLooseOrWereLostAreLeftOut) {
  ScratchFolder folder;
  auto rows = followed_rows(followed_specimen(), 0.02);
  rows[7].motion = {0, 0, -3e-4};
  rows.erase(rows.begin() + 20, rows.begin() + 30);
  std::string table = followed_text(rows, 0.02);
  std::size_t at = 0;
  for (int line = 0; (at = table.find('\n', at)) != std::string::npos; ++line, ++at) {
    const std::string state = line == 0 ? ",state" : line == 8 ? ",loose" : ",followed";
    table.insert(at, state);
    at += state.size();
  }
  const auto experiment = read(folder, "displacements", table, kBeads);
  EXPECT_TRUE(experiment.warnings.empty());
  const auto& ids = experiment.observations[0].column("bead_id");
  EXPECT_EQ(ids.size(), 256u - 11u);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), 8.0), 0);
}

struct Odd {
  std::string name, kind, table, keys, told;
};

class OddObservation : public testing::TestWithParam<Odd> {};

TEST_P(OddObservation, IsUsedWithAWarning) {
  ScratchFolder folder;
  const auto experiment = read(folder, GetParam().kind, GetParam().table, GetParam().keys);
  ASSERT_EQ(experiment.warnings.size(), 1u);
  EXPECT_EQ(experiment.warnings[0].find("one: "), 0u);
  EXPECT_NE(experiment.warnings[0].find(GetParam().told), std::string::npos) << experiment.warnings[0];
}

INSTANTIATE_TEST_SUITE_P(
    Table, OddObservation,
    testing::Values(
        Odd{"CurveWithSigmaZero", "compression",
            rows("strain,stress_pa,stress_sigma_pa",
                 [](int k) { return fmt::format("{},{},0", 0.008 * k, 1.5e5 * k); }),
            "", "stress_sigma_pa holds zeros"},
        Odd{"CoordinationWithSigmaZero", "coordination", "z,z_sigma\n6,0\n", "", "z_sigma holds zeros"},
        Odd{"FieldWithSigmaZero", "displacements", moved([](Followed&) {}, 0.02, 1e-6, 0.0), kBeads,
            "sigma_um holds zeros"},
        Odd{"SpecimenThatShrinksSideways", "lateral_strain",
            rows("strain,lateral_strain", [](int k) { return fmt::format("{},{}", 0.01 * k, -0.003 * k); }),
            "", "expansion is positive"},
        Odd{"EveryPairBridged", "bridges",
            [] {
              std::string text = "bead_i,bead_j\n";
              for (int k = 1; k <= 60; ++k) text += fmt::format("{},{}\n", 4 * k - 3, 4 * k - 2);
              return text;
            }(),
            kBeads, "every pair"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular::diagnosis
