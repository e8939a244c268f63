#include "dem_core/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <limits>

#include "base/error.h"
#include "dem_core/compress.h"
#include "scratch.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::disordered;
using test::sample_a;
using test::ScratchFolder;

/// A state that is told from others by its number of frames.
RunState state_with(int frames) {
  RunState state;
  state.simulation = build_simulation(disordered(2, 2), sample_a());
  state.frames_written = frames;
  return state;
}

/// A folder with checkpoints of one and, newest, two frames.
void keep_two(const fs::path& folder) {
  keep_checkpoint(folder, state_with(1), "work");
  keep_checkpoint(folder, state_with(2), "work");
}

std::string flipped(std::string bytes) {
  bytes[bytes.size() / 2] ^= 1;
  return bytes;
}

TEST(Checkpoint, NewestIsUsed) {
  ScratchFolder folder;
  EXPECT_FALSE(kept_checkpoint(folder.path(), "work"));
  keep_checkpoint(folder.path(), state_with(1), "work");
  EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 1);
  keep_checkpoint(folder.path(), state_with(2), "work");
  EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 2);
}

TEST(Checkpoint, TheOneBeforeStandsInForADamagedOne) {
  ScratchFolder folder;
  keep_two(folder.path());
  const std::string good = read_text(folder / "checkpoint");
  for (const auto& damaged : {std::string(), good.substr(0, 40), good.substr(0, good.size() / 2),
                              good.substr(0, good.size() - 1), flipped(good)}) {
    write_text(folder / "checkpoint", damaged);
    EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 1) << damaged.size();
  }
}

TEST(Checkpoint, TheOneBeforeStandsInForAMissingOne) {
  // As where the program is killed between the two renames.
  ScratchFolder folder;
  keep_two(folder.path());
  fs::remove(folder / "checkpoint");
  EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 1);
}

TEST(Checkpoint, ADamagedOneDoesNotPushTheGoodOneOut) {
  ScratchFolder folder;
  keep_two(folder.path());
  write_text(folder / "checkpoint", "damaged");
  RunState state = *kept_checkpoint(folder.path(), "work");
  state.frames_written = 3;
  keep_checkpoint(folder.path(), state, "work");
  EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 3);
  fs::remove(folder / "checkpoint");
  EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 1);
}

TEST(Checkpoint, BothDamagedIsBadInput) {
  ScratchFolder folder;
  keep_two(folder.path());
  for (const char* name : {"checkpoint", "checkpoint.previous"})
    write_text(folder / name, flipped(read_text(folder / name)));
  EXPECT_THROW(kept_checkpoint(folder.path(), "work"), BadInput);
  fs::remove(folder / "checkpoint");
  EXPECT_THROW(kept_checkpoint(folder.path(), "work"), BadInput);
}

TEST(Checkpoint, APayloadThatLiesUnderARightChecksumIsBadInput) {
  ScratchFolder folder;
  const fs::path path = folder / "checkpoint";
  write_checkpoint(path, state_with(1), "work");
  const std::string good = read_text(path);
  const std::size_t digest = good.find("work") + 5, payload = digest + 65;
  const std::string bytes = good.substr(payload);
  std::string no_flag = bytes;
  no_flag[bytes.size() - 29] = 2;  // `finished`, before the three doubles and the count of the open row
  for (const std::string& lie : {bytes + "x", bytes.substr(0, bytes.size() - 1), no_flag}) {
    write_text(path, good.substr(0, digest) + sha256(lie) + "\n" + lie);
    try {
      read_checkpoint(path, "work");
      ADD_FAILURE() << "accepted";
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    }
  }
}

TEST(Checkpoint, OtherWorkIsBadInput) {
  ScratchFolder folder;
  keep_two(folder.path());
  EXPECT_THROW(kept_checkpoint(folder.path(), "other work"), BadInput);
}

TEST(Checkpoint, AFullDiscLeavesBothGood) {
  ScratchFolder folder;
  keep_two(folder.path());
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small = {4096, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(keep_checkpoint(folder.path(), state_with(3), "work"), ComputationFailed);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_FALSE(fs::exists(folder / "checkpoint.next"));
  EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 2);
  fs::remove(folder / "checkpoint");
  EXPECT_EQ(kept_checkpoint(folder.path(), "work")->frames_written, 1);
}

TEST(Checkpoint, KilledAtAnyMomentLeavesAGoodOne) {
  ScratchFolder folder;
  RunState state = state_with(1);
  keep_two(folder.path());
  for (int round = 0; round < 20; ++round) {
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0)
      for (;; ++state.frames_written) keep_checkpoint(folder.path(), state, "work");
    ::usleep(static_cast<useconds_t>(3000 + 500 * round));
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    EXPECT_NO_THROW(EXPECT_TRUE(kept_checkpoint(folder.path(), "work")));
  }
}

Sample short_test() {
  Sample sample = sample_a();
  sample.compression.max_strain = 0.004;
  sample.compression.frames = 2;
  return sample;
}

TEST(Checkpoint, ResumedFromTheOneBeforeARunEndsWithTheSameBytes) {
  struct Case {
    const char* name;
    Sample sample;
  };
  Sample unloading = short_test(), holding = short_test(), ramp = short_test();
  unloading.compression.unload_at = {0.002, 0.004};
  holding.compression.hold_at = {0.004};  // the checkpoint before the last is from within the hold
  ramp.compression.control = Control::stress;
  ramp.compression.stress_rate = 1e10;
  for (const auto& [name, sample] : {Case{"unloading", unloading}, {"holding", holding}, {"ramp", ramp}}) {
    SCOPED_TRACE(name);
    ScratchFolder folder;
    CompressOptions options;
    options.checkpoint_every = 0.0;
    compress(disordered(3, 3), sample, folder / "run", options);
    std::map<std::string, std::string> whole;
    for (const char* file :
         {"curve.csv", "events.csv", "avalanches.csv", "frames/frame_0002.vtp", "checkpoint"})
      whole[file] = sha256_of(folder / "run" / file);
    write_text(folder / "run" / "checkpoint", "damaged");
    const RunState before =
        read_checkpoint(folder / "run" / "checkpoint.previous", work_identity(disordered(3, 3), sample, ""));
    ASSERT_FALSE(before.finished);
    EXPECT_EQ(before.platen.holding, std::string(name) == "holding");
    options.resume = true;
    compress(disordered(3, 3), sample, folder / "run", options);
    for (const auto& [file, digest] : whole) EXPECT_EQ(sha256_of(folder / "run" / file), digest) << file;
  }
}

TEST(Checkpoint, IsOfThePackingTheSampleAndTheEffectsWhoeverAsks) {
  ScratchFolder folder;
  CompressOptions options;
  options.checkpoint_every = 0.0;
  options.provenance = {"0.1", "pendular compress a.vtp", 1, {{"a.vtp", "aa"}}};
  compress(disordered(3, 3), short_test(), folder / "run", options);
  const std::string curve = read_text(folder / "run" / "curve.csv");
  fs::remove(folder / "run" / "checkpoint");
  options.resume = true;
  options.provenance = {"0.2", "pendular compress b.vtp", 1, {{"b.vtp", "bb"}}};
  Packing renamed = disordered(3, 3);
  renamed.provenance.command = "another";
  compress(renamed, short_test(), folder / "run", options);
  const auto rows = [](const std::string& text) { return text.substr(text.find("strain,")); };
  EXPECT_EQ(rows(read_text(folder / "run" / "curve.csv")), rows(curve));

  Packing moved = disordered(3, 3);
  moved.beads[5].centre.x() += 1e-12;
  EXPECT_THROW(compress(moved, short_test(), folder / "run", options), BadInput);
  Sample slower = short_test();
  slower.compression.speed *= 0.5;
  EXPECT_THROW(compress(disordered(3, 3), slower, folder / "run", options), BadInput);
  options.work = "an effect";
  EXPECT_THROW(compress(disordered(3, 3), short_test(), folder / "run", options), BadInput);
}

TEST(Checkpoint, StaysWhereMotionIsNotANumber) {
  ScratchFolder folder;
  CompressOptions options;
  options.checkpoint_every = 0.0;
  compress(disordered(3, 3), short_test(), folder / "run", options);
  const std::string identity = work_identity(disordered(3, 3), short_test(), "");
  RunState state = read_checkpoint(folder / "run" / "checkpoint.previous", identity);
  state.simulation.beads.velocity[20].x() = std::numeric_limits<double>::quiet_NaN();
  remove_checkpoints(folder / "run");
  write_checkpoint(folder / "run" / "checkpoint", state, identity);
  const std::string before = sha256_of(folder / "run" / "checkpoint");
  options.resume = true;
  EXPECT_THROW(compress(disordered(3, 3), short_test(), folder / "run", options), ComputationFailed);
  EXPECT_EQ(sha256_of(folder / "run" / "checkpoint"), before);
  EXPECT_FALSE(fs::exists(folder / "run" / "checkpoint.previous"));
}

}  // namespace
}  // namespace pendular::dem_core
