#include <gtest/gtest.h>

#include <sstream>

#include "base/files.h"
#include "program.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::Outcome;
using test::ScratchFolder;
using test::shell;

constexpr const char* kPictureLibraries = "libITK|libopencv|libvtk";

TEST(Start, LoadsNoLibraryOfPictures) {
  const ScratchFolder folder;
  EXPECT_EQ(shell(folder.path(), "ldd $P | grep -q libstdc++").status, 0);
  EXPECT_NE(shell(folder.path(), std::string("ldd $P | grep -qE '") + kPictureLibraries + "'").status, 0);
  EXPECT_EQ(
      shell(folder.path(), std::string("ldd $P-pictures | grep -qE '") + kPictureLibraries + "'").status, 0)
      << "the pattern should match what it is meant for";
}

TEST(Start, BothProgramsTellTheSameHelp) {
  const ScratchFolder folder;
  EXPECT_EQ(shell(folder.path(), "$P --help > a && $P-pictures --help > b && test -s a && cmp a b").status,
            0);
}

TEST(Start, AloneItShowsTheChainInFiveLines) {
  const ScratchFolder folder;
  ASSERT_EQ(shell(folder.path(), "$P > told.txt").status, 0);
  std::istringstream lines(test::content(folder / "told.txt"));
  std::string line;
  for (const char* command : {"segment", "pack", "compress", "render", "diagnose"}) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(line.rfind(std::string("pendular ") + command + " ", 0), 0u) << line;
    EXPECT_LE(line.size(), 100u) << line;
  }
  EXPECT_TRUE(std::getline(lines, line) && line.empty()) << line;
}

TEST(Start, WithoutItsCompanionAPictureCommandSaysSo) {
  const ScratchFolder folder;
  const Outcome outcome = shell(folder.path(), "cp $P alone && ./alone segment scan.mha -o beads.csv");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_NE(outcome.errors.find("pendular-pictures: cannot be started"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace pendular
