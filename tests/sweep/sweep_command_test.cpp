#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "program.h"
#include "scratch.h"
#include "sweep/store.h"
#include "sweep_files.h"

namespace pendular::sweep {
namespace {

using test::content;
using test::run_bytes;
using test::ScratchFolder;
using test::shell;
using test::write_sweep;

constexpr const char* kFourRuns = "realisations = 2\n[grid]\n\"contact.friction\" = [0.1, 0.5]\n";

/// Four runs of some seconds' work in all.
void write_longer_sweep(const fs::path& folder) {
  write_sweep(folder, kFourRuns, test::tiny_sample("max_strain = 0.1\nframes = 4\n"));
}

void expect_same(const fs::path& a, const fs::path& b) {
  for (const char* table : {"results.csv", "summary.csv"}) EXPECT_EQ(content(a / table), content(b / table));
  EXPECT_EQ(run_bytes(a / "store"), run_bytes(b / "store"));
}

TEST(SweepCommand, TablesHoldRunsAndTheirMeans) {
  ScratchFolder folder;
  write_sweep(folder.path(), kFourRuns);
  const auto outcome = shell(folder.path(), "$P sweep sweep.toml -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const CsvTable runs = read_csv(folder / "out" / "results.csv",
                                 {"point", "contact.friction", "realisation", "seed", "linear_modulus_pa",
                                  "peak_stress_pa", "work_balance_error"},
                                 {"run", "status", "message"});
  ASSERT_EQ(runs.rows(), 4u);
  EXPECT_EQ(runs.integers("point"), (std::vector<long long>{1, 1, 2, 2}));
  EXPECT_EQ(runs.numbers("contact.friction"), (std::vector<double>{0.1, 0.1, 0.5, 0.5}));
  EXPECT_EQ(runs.integers("seed"), (std::vector<long long>{1, 2, 1, 2}));
  const CsvTable points = read_csv(folder / "out" / "summary.csv",
                                   {"point", "runs", "failed", "peak_stress_pa_mean", "peak_stress_pa_sd",
                                    "peak_stress_pa_standard_error", "peak_stress_pa_n"});
  ASSERT_EQ(points.rows(), 2u);
  const auto peaks = runs.numbers("peak_stress_pa");
  EXPECT_NE(peaks[2], peaks[3]) << "realisations differ";
  EXPECT_NEAR(points.numbers("peak_stress_pa_mean")[1], 0.5 * (peaks[2] + peaks[3]), 1e-9 * peaks[2]);
  EXPECT_NEAR(points.numbers("peak_stress_pa_sd")[1], std::fabs(peaks[2] - peaks[3]) / std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(points.numbers("peak_stress_pa_standard_error")[1], 0.5 * std::fabs(peaks[2] - peaks[3]), 1e-3);
  EXPECT_EQ(points.integers("peak_stress_pa_n"), (std::vector<long long>{2, 2}));
}

TEST(SweepCommand, OfAPackingFileItIsWhatCompressMakes) {
  ScratchFolder folder;
  write_sweep(folder.path(), "packing = \"p.vtp\"\nseed = 4\nrealisations = 2\n");
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp --seed 9").status, 0);
  const auto swept = shell(folder.path(), "$P sweep sweep.toml -o out");
  ASSERT_EQ(swept.status, 0) << swept.errors;
  ASSERT_EQ(shell(folder.path(), "$P compress p.vtp --sample s.toml --seed 5 -o run").status, 0);
  const auto modulus =
      nlohmann::json::parse(content(folder / "run" / "result.json"))["linear_modulus_pa"]["value"]
          .get<double>();
  EXPECT_EQ(read_csv(folder / "out" / "results.csv", {"linear_modulus_pa"}).numbers("linear_modulus_pa")[1],
            modulus);

  // The store's copy is checked when it is used.
  for (const auto& entry : fs::directory_iterator(folder / "out" / "store" / "packings"))
    write_text(entry.path(), "damaged");
  const auto damaged = shell(folder.path(), "$P sweep sweep.toml -o out --seed 20");
  EXPECT_EQ(damaged.status, 4);
  EXPECT_NE(damaged.errors.find("is not the packing that it was"), std::string::npos) << damaged.errors;
}

TEST(SweepCommand, SameBytesForAnyThreadCountAndFolder) {
  ScratchFolder folder;
  write_sweep(folder.path(), kFourRuns);
  for (const char* command :
       {"$P sweep sweep.toml -o one --threads 1", "$P sweep sweep.toml -o two --threads 2",
        "$P sweep sweep.toml -o eight --threads 8"})
    ASSERT_EQ(shell(folder.path(), command).status, 0);
  expect_same(folder / "one", folder / "two");
  expect_same(folder / "one", folder / "eight");
}

TEST(SweepCommand, RunsInTheStoreAreNotMadeAgain) {
  ScratchFolder folder;
  write_sweep(folder.path(), kFourRuns);
  ASSERT_EQ(shell(folder.path(), "$P sweep sweep.toml -o out --store common").status, 0);
  const auto made = fs::last_write_time(folder / "common" / "runs");
  write_sweep(folder.path(), "realisations = 2\n[grid]\n\"contact.friction\" = [0.5]\n");
  ASSERT_EQ(shell(folder.path(), "$P sweep sweep.toml -o less --store common").status, 0);
  EXPECT_EQ(fs::last_write_time(folder / "common" / "runs"), made);
  const auto dry = shell(folder.path(), "$P sweep sweep.toml -o less --store common --dry-run");
  EXPECT_NE(dry.errors.find("2 runs: 2 in the store, 0 failed before, 0 to make"), std::string::npos)
      << dry.errors;
}

TEST(SweepCommand, DryRunSaysHowMuchAndMakesNothing) {
  ScratchFolder folder;
  write_sweep(folder.path(), kFourRuns);
  const auto dry = shell(folder.path(), "$P sweep sweep.toml -o out --dry-run");
  EXPECT_EQ(dry.status, 0);
  EXPECT_NE(dry.errors.find("4 runs: 0 in the store, 0 failed before, 4 to make"), std::string::npos)
      << dry.errors;
  EXPECT_NE(dry.errors.find("a guess until the store has runs"), std::string::npos) << dry.errors;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

class StoppedSweep : public testing::TestWithParam<const char*> {};

TEST_P(StoppedSweep, GoesOnToTheSameBytes) {
  ScratchFolder folder;
  write_longer_sweep(folder.path());
  ASSERT_EQ(shell(folder.path(), "$P sweep sweep.toml -o whole --threads 2").status, 0);
  const bool killed = std::string(GetParam()) == "KILL";
  const auto stopped =
      shell(folder.path(), std::string("$P sweep sweep.toml -o stopped --threads 2 & pid=$!; "
                                       "until ls stopped/store/runs/*/frames/frame_0001.vtp || ! kill -0 "
                                       "$pid; do sleep 0.02; done; kill -") +
                               GetParam() + " $pid; wait $pid");
  EXPECT_EQ(stopped.status, killed ? 137 : 130) << stopped.errors;
  EXPECT_FALSE(fs::exists(folder / "stopped" / "results.csv"));
  const auto resumed = shell(folder.path(), "$P sweep sweep.toml -o stopped --threads 2 --resume");
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  expect_same(folder / "whole", folder / "stopped");
}

INSTANTIATE_TEST_SUITE_P(Signals, StoppedSweep, testing::Values("INT", "TERM", "KILL"),
                         [](const auto& test) { return std::string(test.param); });

TEST(SweepCommand, AllProcessesKilledAtOnceLoseNothing) {
  ScratchFolder folder;
  write_longer_sweep(folder.path());
  ASSERT_EQ(shell(folder.path(), "$P sweep sweep.toml -o whole --threads 2").status, 0);
  shell(folder.path(),
        "setsid $P sweep sweep.toml -o stopped --threads 2 & pid=$!; "
        "until ls stopped/store/runs/*/frames/frame_0001.vtp || ! kill -0 $pid; do sleep 0.02; done; kill -9 "
        "-- -$pid; wait "
        "$pid");
  const auto resumed = shell(folder.path(), "$P sweep sweep.toml -o stopped --threads 2");
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  expect_same(folder / "whole", folder / "stopped");
}

TEST(SweepCommand, TwoSweepsAtOnceShareOneStore) {
  ScratchFolder folder;
  write_longer_sweep(folder.path());
  ASSERT_EQ(shell(folder.path(), "$P sweep sweep.toml -o whole").status, 0);
  const auto both =
      shell(folder.path(),
            "$P sweep sweep.toml -o a --store a/store & first=$!; "
            "$P sweep sweep.toml -o b --store a/store & second=$!; wait $first && wait $second");
  ASSERT_EQ(both.status, 0) << both.errors;
  expect_same(folder / "whole", folder / "a");
  EXPECT_EQ(content(folder / "b" / "results.csv"), content(folder / "whole" / "results.csv"));
}

TEST(SweepCommand, AFailedRunIsShownAndNotRetriedInSilence) {
  ScratchFolder folder;
  write_sweep(folder.path(), "[grid]\n\"bridges.cutoff\" = [0.064, 0]\n");
  for (int round = 0; round < 2; ++round) {
    const auto outcome = shell(folder.path(), "$P sweep sweep.toml -o out");
    EXPECT_EQ(outcome.status, 4);
    EXPECT_NE(outcome.errors.find("1 of 2 runs failed"), std::string::npos) << outcome.errors;
    EXPECT_NE(outcome.errors.find("found no bridge"), std::string::npos) << outcome.errors;
  }
  const CsvTable runs = read_csv(folder / "out" / "results.csv", {"status", "message", "peak_stress_pa"});
  EXPECT_EQ(runs.texts("status"), (std::vector<std::string>{"done", "failed"}));
  EXPECT_NE(runs.texts("message")[1].find("found no bridge"), std::string::npos);
  EXPECT_EQ(runs.texts("peak_stress_pa")[1], "");
  const CsvTable points = read_csv(folder / "out" / "summary.csv", {"failed", "peak_stress_pa_n"});
  EXPECT_EQ(points.integers("failed"), (std::vector<long long>{0, 1}));
  EXPECT_EQ(points.integers("peak_stress_pa_n"), (std::vector<long long>{1, 0}));

  // What failed for a reason that has gone is made when asked for.
  Store store(folder / "out" / "store");
  const std::string done = read_csv(folder / "out" / "results.csv", {"run"}).texts("run")[0];
  fs::rename(store.run_folder(done), folder / "kept");
  Database(folder / "out" / "store" / "index.sqlite").run("UPDATE runs SET status = 'running'");
  store.fail(done, 4, "disc full");
  EXPECT_NE(shell(folder.path(), "$P sweep sweep.toml -o out").errors.find("disc full"), std::string::npos);
  EXPECT_EQ(shell(folder.path(), "$P sweep sweep.toml -o out --retry-failed").status, 4);
  EXPECT_EQ(store.record(done).status, RunStatus::done);
  EXPECT_EQ(sha256_of(folder / "kept"), sha256_of(store.run_folder(done)));
}

struct BadCommand {
  const char* name;
  const char* command;
  int status;
  const char* expected;
};

class SweepBadCommand : public testing::TestWithParam<BadCommand> {};

TEST_P(SweepBadCommand, GivesOneLineAndTheRightStatus) {
  ScratchFolder folder;
  write_sweep(folder.path(), "[grid]\nW = [0.02]\n");
  write_text(folder / "typo.toml", "[sweep]\nsample = \"s.toml\"\n[grid]\n\"bridges.gap\" = [1]\n");
  write_text(folder / "file", "a file");
  fs::create_directories(folder / "later");
  Database(folder / "later" / "index.sqlite").run("PRAGMA user_version = 7");
  const auto& bad = GetParam();
  const auto outcome = shell(folder.path(), bad.command);
  EXPECT_EQ(outcome.status, bad.status) << outcome.errors;
  EXPECT_NE(outcome.errors.find(bad.expected), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder / "out" / "results.csv"));
}

INSTANTIATE_TEST_SUITE_P(
    Table, SweepBadCommand,
    testing::Values(
        BadCommand{"Absent", "$P sweep absent.toml -o out", 3, "absent.toml"},
        BadCommand{"NoOut", "$P sweep sweep.toml", 2, "--out"},
        BadCommand{"UnknownKey", "$P sweep typo.toml -o out", 3, "typo.toml:4: bridges.gap: unknown key"},
        BadCommand{"Executor", "$P sweep sweep.toml -o out --executor pbs", 2, "pbs"},
        BadCommand{"SlurmOptions", "$P sweep sweep.toml -o out --slurm-options x", 2, "--executor slurm"},
        BadCommand{"OutIsAFile", "$P sweep sweep.toml -o file", 3, "file: is a file"},
        BadCommand{"LaterStore", "$P sweep sweep.toml -o out --store later", 3, "found a store of version 7"},
        BadCommand{"NoStore", "$P sweep-run absent 00", 3, "is no store"},
        BadCommand{"NoSlurm", "PATH=/nowhere $P sweep sweep.toml -o out --executor slurm", 4,
                   "sbatch took no job"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pendular::sweep
