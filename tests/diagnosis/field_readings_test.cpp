#include "diagnosis/bank/field_readings.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "diagnosis/bank/design.h"
#include "diagnosis/experiment/experiment.h"
#include "followed.h"
#include "packing/bridges.h"
#include "packing/tables.h"
#include "sample_file.h"
#include "scratch.h"

namespace pendular::diagnosis {
namespace {

using test::Followed;
using test::followed_rows;
using test::followed_specimen;

constexpr double kStrain = 0.02;

/// A scan of a specimen whose beads were measured, and a bank of six baselines and three bent ones.
class FieldReadingsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write_beads(folder / "beads.csv", followed_specimen(), {});
    write_text(folder / "sample.toml",
               pendular::test::sample_file(
                   "[beads]\ndiameter_um = 200\n[specimen]\ndiameter_um = 1300\nheight_um = 1200\n"));
    write_text(
        folder / "e.toml",
        "[experiment]\nsample = \"sample.toml\"\n[[observation]]\nkind = \"displacements\"\nname = \"scan\"\n"
        "file = \"scan.csv\"\nbeads = \"beads.csv\"\n");
    for (int member = 1; member <= 6; ++member) add(member, 0.0);
    for (int level = 1; level <= 3; ++level) add(level, 0.5 * level);
  }

  /// What is read of a scan, and of the bank.
  struct Readings {
    std::vector<Feature> observed;
    std::vector<Eigen::VectorXd> of_runs;
    Eigen::VectorXd by_noise;
    Eigen::MatrixXd model;
  };

  FieldBank bank_of(const std::string& scan) {
    write_text(folder / "scan.csv", scan);
    experiment = read_experiment(folder / "e.toml");
    plan.conditions = {{experiment.sample, folder / "beads.csv", {0}}};
    plan.size = {1.0};
    return field_bank(experiment, plan, 0, tests).value();
  }

  Readings read(const std::vector<Followed>& rows, double sigma_um = 0.1) {
    const FieldBank bank = bank_of(test::followed_text(rows, kStrain, 1e-6, sigma_um));
    const FieldReader reader(bank, plan.points);
    Readings readings{
        reader.measured(bank), reader.of_runs(bank, plan.points), reader.by_noise(bank, plan.points), {}};
    readings.model = field_model_error({readings.of_runs.begin(), readings.of_runs.begin() + 6});
    return readings;
  }

  static std::vector<Followed> bent(double theta) {
    auto rows = followed_rows(followed_specimen(), kStrain);
    for (auto& row : rows) row.motion.x() += bending(theta, row.at);
    return rows;
  }

  /// With an error of every component, m.
  static std::vector<Followed> seen_with(double error, std::vector<Followed> rows) {
    for (auto& row : rows)
      for (int axis = 0; axis < 3; ++axis)
        row.motion[axis] +=
            error * random_normal(71, 3 * static_cast<std::uint64_t>(row.id) + static_cast<unsigned>(axis));
    return rows;
  }

  /// A run as believed but for an unstated error of the beads' places, um.
  void add_misplaced(double theta) {
    DesignPoint point;
    point.id = "position_error", point.theta = theta, point.changes = {{point.id, theta}};
    plan.points.push_back(point);
    tests.push_back(tests.front());
  }

  static double of_run(const Readings& readings, std::size_t run, const std::string& name) {
    for (std::size_t k = 0; k < readings.observed.size(); ++k)
      if (readings.observed[k].name == name + "_at_2.00_percent")
        return readings.of_runs[run][static_cast<Eigen::Index>(k)];
    return std::nan("");
  }

  static double named(const Readings& readings, const std::string& name) {
    for (const auto& feature : readings.observed)
      if (feature.name == name + "_at_2.00_percent") return feature.value;
    return std::nan("");
  }

  pendular::test::ScratchFolder folder;
  Experiment experiment;
  BankPlan plan;
  std::vector<SimulatedTests> tests;

 private:
  static double bending(double theta, const Vec3& at) { return 3e-6 * theta * std::sin(3e3 * at.z()); }

  void add(int member, double tilt) {
    DesignPoint point;
    point.member = member;
    if (tilt > 0.0) point.id = "platen_tilt", point.theta = tilt, point.changes = {{"platen_tilt", tilt}};
    plan.points.push_back(point);
    SimulatedTest test;
    test.frames.resize(1);
    test.frames[0].strain = kStrain;
    for (const auto& bead : followed_specimen()) {
      const auto draw = static_cast<std::uint64_t>(bead.id);
      test.frames[0].ids.push_back(bead.id);
      test.frames[0].rest.push_back(bead.centre);
      test.frames[0].displacement.push_back(
          test::compressed(bead.centre, kStrain) + Vec3(bending(tilt, bead.centre), 0, 0) +
          1e-7 * Vec3(random_normal(static_cast<std::uint64_t>(member), 3 * draw),
                      random_normal(static_cast<std::uint64_t>(member), 3 * draw + 1),
                      random_normal(static_cast<std::uint64_t>(member), 3 * draw + 2)));
    }
    tests.push_back({std::make_shared<const SimulatedTest>(std::move(test))});
  }
};

}  // namespace

TEST_F(FieldReadingsTest, ATurnedShiftedAndScaledScanAreTheSame) {
  const auto rows = bent(0.8);
  auto turned = rows;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.2, Vec3(0.03, 0.02, 1.0).normalized()).toRotationMatrix();
  for (auto& row : turned)
    row.motion = 1.006 * (turn * (row.at + row.motion)) + Vec3(2e-5, -4e-5, 3e-5) - row.at;
  const Readings one = read(rows), other = read(turned);
  ASSERT_EQ(one.observed.size(), other.observed.size());
  for (std::size_t k = 0; k < one.observed.size(); ++k)
    EXPECT_NEAR(one.observed[k].value, other.observed[k].value, 1e-6) << one.observed[k].name;
  EXPECT_GT(std::fabs(named(one, "mode_1")), 0.5);
}

TEST_F(FieldReadingsTest, SimulatedFieldsHaveNoiseOfTheStatedSize) {
  // The field as believed, seen with an error of 0.5 um: the baselines' readings scatter about what it shows.
  const auto rows = seen_with(5e-7, bent(0.0));
  const Readings stated = read(rows, 0.5), understated = read(rows, 0.1);
  const auto off = [&](const Readings& of) {
    double mean = 0.0;
    for (std::size_t k = 0; k < 6; ++k) mean += of_run(of, k, "pairs_sliding") / 6.0;
    return named(of, "pairs_sliding") - mean;
  };
  EXPECT_LT(std::fabs(off(stated)), 0.3);
  EXPECT_GT(off(understated), 0.8);  // noise that is not stated looks like motion
  EXPECT_GT(stated.by_noise.norm(), 0.0);
}

TEST_F(FieldReadingsTest, UnstatedErrorsOfPlacesAreThoseOfMotionInEitherScan) {
  add_misplaced(3.0);
  const Readings seen = read(seen_with(M_SQRT2 * 3e-6, bent(0.0)));
  for (const char* name : {"field_size", "left_size", "pairs_parting", "pairs_sliding"}) {
    EXPECT_NEAR(of_run(seen, 9, name), named(seen, name), 0.1) << name;
    EXPECT_LT(of_run(seen, 0, name), named(seen, name) - 2.0) << name;
  }
}

TEST_F(FieldReadingsTest, ErrorsOfPlacesAreNoLargerThanTheMotionShows) {
  add_misplaced(3.0);
  const Readings none = read(bent(0.0)), some = read(seen_with(1e-6, bent(0.0)));
  EXPECT_NEAR(of_run(none, 9, "pairs_sliding"), of_run(none, 0, "pairs_sliding"), 0.3);
  EXPECT_NEAR(of_run(some, 9, "pairs_sliding"), named(some, "pairs_sliding"), 0.1);
}

TEST_F(FieldReadingsTest, TheErrorOfPlacesAtRestIsInEveryScan) {
  add_misplaced(3.0);
  const auto rows = seen_with(M_SQRT2 * 3e-6, bent(0.0));
  const std::string second = test::followed_text(rows, kStrain);
  const FieldBank bank =
      bank_of(test::followed_text(rows, 0.5 * kStrain) + second.substr(second.find('\n') + 1));
  const Eigen::VectorXd errors = *bank.of_runs[9] - *bank.of_runs[0];
  const Eigen::Index size = errors.size() / 2;
  const double first = errors.head(size).norm(), last = errors.tail(size).norm();
  EXPECT_NEAR(first / std::sqrt(static_cast<double>(size)), M_SQRT2 * 3.0, 0.2);
  EXPECT_NEAR(errors.head(size).dot(errors.tail(size)) / (first * last), 0.5, 0.1);
}

TEST_F(FieldReadingsTest, RunsThatFailedShowNothing) {
  tests[7] = {nullptr};
  const Readings readings = read(bent(0.3));
  ASSERT_EQ(readings.of_runs.size(), 9u);
  EXPECT_TRUE(readings.of_runs[7].array().isNaN().all());
  EXPECT_TRUE(readings.of_runs[6].allFinite());
  EXPECT_GT(readings.model.diagonal().minCoeff(), 0.0);
}

TEST_F(FieldReadingsTest, ABeadOnTwoBondsIsNotRead) {
  const auto rows = bent(0.8);
  const Readings without = read(rows);
  auto beads = followed_specimen();
  Bead loose = beads[0];  // below the first two, which touch, and no other
  loose.id = 257;
  loose.centre = 0.5 * (beads[0].centre + beads[1].centre) - Vec3(0.0, 0.0, 0.87 * loose.diameter);
  beads.push_back(loose);
  ASSERT_EQ(candidate_bridges(beads, 12.8e-6).size(),
            candidate_bridges(followed_specimen(), 12.8e-6).size() + 2);
  write_beads(folder / "beads.csv", beads, {});
  for (auto& test : tests) {
    auto longer = std::make_shared<SimulatedTest>(*test[0]);
    longer->frames[0].ids.push_back(loose.id);
    longer->frames[0].rest.push_back(loose.centre);
    longer->frames[0].displacement.push_back(Vec3::Zero());
    test[0] = std::move(longer);
  }
  auto more = rows;
  more.push_back({loose.id, loose.centre, Vec3(1e-5, 0.0, 2e-5)});
  const Readings with = read(more);
  ASSERT_EQ(with.observed.size(), without.observed.size());
  for (std::size_t k = 0; k < with.observed.size(); ++k)
    EXPECT_EQ(with.observed[k].value, without.observed[k].value) << with.observed[k].name;
}

TEST_F(FieldReadingsTest, BeadsThatTheScanLostAreNoLoss) {
  const auto rows = bent(0.8);
  auto some = rows;
  std::erase_if(some, [](const Followed& row) { return row.id % 12 == 0; });
  const Readings whole = read(rows), part = read(some);
  ASSERT_EQ(whole.observed.size(), part.observed.size());
  EXPECT_NEAR(std::fabs(named(part, "mode_1")), std::fabs(named(whole, "mode_1")),
              0.1 * std::fabs(named(whole, "mode_1")));
  EXPECT_NEAR(named(part, "field_size"), named(whole, "field_size"), 0.1);
}

TEST_F(FieldReadingsTest, BeadsThatNothingHoldsAreNotReadAndThatIsSaid) {
  auto apart = followed_specimen();
  for (auto& bead : apart) bead.centre *= 1.2;
  write_beads(folder / "beads.csv", apart, {});
  write_text(folder / "scan.csv", test::followed_text(followed_rows(apart, kStrain), kStrain));
  experiment = read_experiment(folder / "e.toml");
  plan.conditions = {{experiment.sample, folder / "beads.csv", {0}}};
  plan.size = {1.0};
  EXPECT_FALSE(field_bank(experiment, plan, 0, tests));
  std::vector<std::string> warnings;
  const BankFeatures features(Level::readings, experiment, plan, tests);
  EXPECT_THROW(features.design(warnings), BadInput);  // there is nothing else
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("scan: its displacements are not used"), std::string::npos) << warnings[0];
}

TEST_F(FieldReadingsTest, WithoutABaselineThereAreNone) {
  for (std::size_t k = 0; k < 6; ++k) tests[k] = {nullptr};
  write_text(folder / "scan.csv", test::followed_text(bent(0.3), kStrain));
  experiment = read_experiment(folder / "e.toml");
  plan.conditions = {{experiment.sample, folder / "beads.csv", {0}}};
  plan.size = {1.0};
  EXPECT_FALSE(field_bank(experiment, plan, 0, tests));
}

}  // namespace pendular::diagnosis
