#include <gtest/gtest.h>

#include "base/files.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::ScratchFolder;
using test::shell;

/// Starts a compression, waits until its first frame is there, and sends `signal` a moment later.
std::string interrupted_run(const char* signal) {
  return std::string(
             "$P compress p.vtp --sample s.toml -o stopped & pid=$!; "
             "until [ -e stopped/frames/frame_0001.vtp ]; do sleep 0.02; done; kill -") +
         signal + " $pid; wait $pid";
}

class Interrupt : public testing::TestWithParam<const char*> {};

TEST_P(Interrupt, ResumedRunEndsWithTheSameBytes) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample("max_strain = 0.06\nframes = 12\n"));
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp").status, 0);
  ASSERT_EQ(shell(folder.path(), "$P compress p.vtp --sample s.toml -o whole").status, 0);

  const bool killed = std::string(GetParam()) == "KILL";
  const auto stopped = shell(folder.path(), interrupted_run(GetParam()));
  EXPECT_EQ(stopped.status, killed ? 137 : 130) << stopped.errors;
  EXPECT_EQ(fs::exists(folder / "stopped" / "checkpoint"), !killed);
  EXPECT_FALSE(fs::exists(folder / "stopped" / "curve.csv"));
  EXPECT_FALSE(fs::exists(folder / "stopped" / "result.json"));

  const auto resumed = shell(folder.path(), "$P compress p.vtp --sample s.toml -o stopped --resume");
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  for (const char* file :
       {"curve.csv", "events.csv", "checkpoint", "frames/frame_0003.vtp", "frames/frame_0012.vtp"})
    EXPECT_EQ(sha256_of(folder / "whole" / file), sha256_of(folder / "stopped" / file)) << file;
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values("INT", "TERM", "KILL"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Resume, ANewRunLeavesNothingOfAnEarlierOne) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample("max_strain = 0.002\nframes = 4\n"));
  write_text(folder / "few.toml", test::small_sample("max_strain = 0.002\nframes = 1\n"));
  ASSERT_EQ(shell(folder.path(),
                  "$P pack --generate --sample s.toml -o p.vtp && $P compress p.vtp --sample s.toml -o run")
                .status,
            0);
  EXPECT_TRUE(fs::exists(folder / "run" / "frames" / "frame_0004.vtp"));
  ASSERT_EQ(shell(folder.path(), "$P compress p.vtp --sample few.toml -o run").status, 0);
  EXPECT_TRUE(fs::exists(folder / "run" / "frames" / "frame_0001.vtp"));
  EXPECT_FALSE(fs::exists(folder / "run" / "frames" / "frame_0002.vtp"));
}

TEST(Resume, ADamagedCheckpointGivesWayToTheOneBefore) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample("max_strain = 0.06\nframes = 12\n"));
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp").status, 0);
  ASSERT_EQ(shell(folder.path(), interrupted_run("INT")).status, 130);
  const auto resume = "$P compress p.vtp --sample s.toml -o stopped --resume";
  ASSERT_EQ(shell(folder.path(), resume).status, 0);
  const std::string curve = sha256_of(folder / "stopped" / "curve.csv");
  ASSERT_TRUE(fs::exists(folder / "stopped" / "checkpoint.previous"));
  write_text(folder / "stopped" / "checkpoint", "damaged");
  const auto again = shell(folder.path(), resume);
  EXPECT_EQ(again.status, 0);
  EXPECT_NE(again.errors.find("going on from the one before"), std::string::npos) << again.errors;
  EXPECT_EQ(sha256_of(folder / "stopped" / "curve.csv"), curve);
  for (const char* name : {"checkpoint", "checkpoint.previous"})
    write_text(folder / "stopped" / name, "damaged");
  EXPECT_EQ(shell(folder.path(), resume).status, 3);
}

TEST(Resume, AnotherSeedIsRefused) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample("max_strain = 0.002\nframes = 1\n"));
  ASSERT_EQ(shell(folder.path(),
                  "$P pack --generate --sample s.toml -o p.vtp && $P compress p.vtp --sample s.toml -o run")
                .status,
            0);
  const auto other = shell(folder.path(), "$P compress p.vtp --sample s.toml -o run --seed 7 --resume");
  EXPECT_EQ(other.status, 3);
  EXPECT_NE(other.errors.find("checkpoint belongs to another"), std::string::npos) << other.errors;
}

}  // namespace
}  // namespace pendular
