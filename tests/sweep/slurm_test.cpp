#include <gtest/gtest.h>
#include <unistd.h>

#include "base/csv.h"
#include "places.h"
#include "program.h"
#include "scratch.h"
#include "sweep_files.h"

namespace pendular::sweep {
namespace {

using test::content;
using test::run_bytes;
using test::ScratchFolder;

/// A Slurm cluster of this machine, for one test.
class Slurm : public testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0 || std::system("command -v sbatch slurmctld slurmd munged >/dev/null") != 0)
      GTEST_SKIP() << "needs root and the packages slurm-wlm and munge";
    started_ = true;
    const auto start = test::shell(folder_.path(), kScript + " start slurm");
    ASSERT_EQ(start.status, 0) << start.errors;
    test::write_sweep(folder_.path(), "realisations = 2\n[grid]\n\"contact.friction\" = [0.1, 0.5]\n");
  }
  void TearDown() override {
    if (started_) test::shell(folder_.path(), kScript + " stop slurm");
  }
  test::Outcome shell(const std::string& command) const {
    return test::shell(folder_.path(), "export SLURM_CONF=$PWD/slurm/slurm.conf; " + command);
  }

  static inline const std::string kScript = pendular::test::source_folder() + "/scripts/slurm_one_node";
  ScratchFolder folder_;

 private:
  bool started_ = false;
};

TEST_F(Slurm, ResultsAreTheSameBytesAsLocalOnes) {
  ASSERT_EQ(shell("$P sweep sweep.toml -o here").status, 0);
  const auto sent = shell("$P sweep sweep.toml -o there --executor slurm --slurm-options '--time=10'");
  ASSERT_EQ(sent.status, 0) << sent.errors;
  for (const char* table : {"results.csv", "summary.csv"})
    EXPECT_EQ(content(folder_ / "here" / table), content(folder_ / "there" / table));
  EXPECT_EQ(run_bytes(folder_ / "here" / "store"), run_bytes(folder_ / "there" / "store"));
}

TEST_F(Slurm, AFailedRunIsRecordedWithItsReason) {
  test::write_sweep(folder_.path(), "[grid]\n\"bridges.cutoff\" = [0.064, 0]\n");
  const auto sent = shell("$P sweep sweep.toml -o out --executor slurm");
  EXPECT_EQ(sent.status, 4);
  EXPECT_NE(sent.errors.find("1 of 2 runs failed"), std::string::npos) << sent.errors;
  EXPECT_NE(sent.errors.find("found no bridge"), std::string::npos) << sent.errors;
}

/// A sweep whose jobs wait, and what is done once they are in the queue.
std::string while_waiting(const std::string& command) {
  return "$P sweep sweep.toml -o out --executor slurm --slurm-options '--begin=now+1hour' & pid=$!; "
         "until [ \"$(squeue --noheader --array | wc -l)\" = 4 ] || ! kill -0 $pid; do sleep 0.1; done; " +
         command + "; wait $pid";
}

TEST_F(Slurm, ALostJobIsAFailedRunAndIsMadeWhenAskedFor) {
  const auto lost = shell(while_waiting("scancel --me"));
  EXPECT_EQ(lost.status, 4);
  EXPECT_NE(lost.errors.find("4 of 4 runs failed"), std::string::npos) << lost.errors;
  const CsvTable runs = read_csv(folder_ / "out" / "results.csv", {"message"});
  for (const auto& message : runs.texts("message"))
    EXPECT_NE(message.find("lost by the scheduler: job"), std::string::npos) << message;
  EXPECT_EQ(shell("$P sweep sweep.toml -o out --retry-failed").status, 0);
}

TEST_F(Slurm, InterruptedItTakesItsJobsOutOfTheQueue) {
  EXPECT_EQ(shell(while_waiting("kill -INT $pid")).status, 130);
  EXPECT_EQ(shell("sleep 1; [ -z \"$(squeue --noheader)\" ]").status, 0);
  EXPECT_EQ(shell("$P sweep sweep.toml -o out").status, 0) << "nothing is lost: the runs still wait";
}

}  // namespace
}  // namespace pendular::sweep
