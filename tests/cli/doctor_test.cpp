#include <gtest/gtest.h>

#include <sstream>

#include "base/files.h"
#include "program.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::content;
using test::Outcome;
using test::ScratchFolder;
using test::shell;

/// The line on a part, of what doctor printed.
std::string line_on(const fs::path& told, const std::string& part) {
  std::istringstream lines(content(told));
  for (std::string line; std::getline(lines, line);)
    if (line.substr(0, 9 + part.size()).find(part) != std::string::npos) return line;
  return "";
}

/// PATH holds nothing but what a test puts there.
struct Doctor : ::testing::Test {
  ScratchFolder folder;

  void SetUp() override { fs::create_directory(folder / "bin"); }

  void install(const std::string& program) {
    write_text(folder / "bin" / program, "#!/bin/sh\nexit 0\n");
    fs::permissions(folder / "bin" / program, fs::perms::owner_all);
  }

  Outcome examine(const std::string& program = "$P") {
    return shell(folder.path(), "PATH=$PWD/bin " + program + " doctor > told.txt");
  }

  std::string line(const std::string& part) { return line_on(folder / "told.txt", part); }
};

TEST_F(Doctor, NamesWhatIsThereAndWhereAndWhatIsNotAndItsRemedy) {
  install("Xvfb"), install("ffmpeg"), install("python3");
  EXPECT_EQ(examine().status, 0);
  EXPECT_EQ(line("pendular-pictures").rfind("present", 0), 0u);
  EXPECT_EQ(line("ffmpeg").rfind("present", 0), 0u);
  EXPECT_NE(line("ffmpeg").find((folder / "bin" / "ffmpeg").string()), std::string::npos);
  EXPECT_EQ(line("Python module").rfind("present", 0), 0u);
  for (const auto& [part, remedy] : {std::pair{"Slurm", "apt-get install slurm-wlm"},
                                     {"Yade", "apt-get install yade"},
                                     {"Chromium", "apt-get install chromium"}}) {
    EXPECT_EQ(line(part).rfind("absent", 0), 0u) << part;
    EXPECT_NE(line(part).find(remedy), std::string::npos) << part;
  }
  fs::remove(folder / "bin" / "ffmpeg");
  EXPECT_EQ(examine().status, 0) << "an optional part";
  EXPECT_EQ(line("ffmpeg").rfind("absent", 0), 0u);
}

TEST_F(Doctor, WithoutWhatPicturesNeedTheStatusSaysSo) {
  EXPECT_EQ(shell(folder.path(), "unset DISPLAY; PATH=$PWD/bin $P doctor > told.txt").status, 4);
  EXPECT_EQ(line("X server").rfind("absent", 0), 0u);
  install("Xvfb");
  EXPECT_EQ(shell(folder.path(), "cp $P alone").status, 0);
  EXPECT_EQ(examine("./alone").status, 4);
  EXPECT_EQ(line("pendular-pictures").rfind("absent", 0), 0u);
}

}  // namespace
}  // namespace pendular
