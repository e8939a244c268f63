#include "base/own_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "base/mapped_file.h"
#include "scratch.h"

namespace pendular {
namespace {

/// Each in a process of its own, which EXPECT_EXIT makes: what is owned stays owned.
[[noreturn]] void speak_while_silent() {
  {
    const SilentStandardError silent;
    std::fputs("of a library\n", stderr);
  }
  std::fputs("of the program\n", stderr);
  ::_exit(0);
}

TEST(OwnProcess, AProgramSilencesItsLibraries) {
  EXPECT_EXIT((own_process(), speak_while_silent()), testing::ExitedWithCode(0), "^of the program\n$");
}

TEST(OwnProcess, ALibraryLeavesStandardErrorToItsCaller) {
  EXPECT_EXIT(speak_while_silent(), testing::ExitedWithCode(0), "^of a library\nof the program\n$");
}

[[noreturn]] void read_a_file_that_is_cut(const fs::path& path) {
  const MappedFile file(path);
  fs::resize_file(path, 0);
  ::_exit(file.data()[0] == std::byte{'x'} ? 0 : 1);
}

TEST(OwnProcess, AMappedFileCutInUseEndsAProgramInOneLine) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "volume.raw") << std::string(8192, 'x');
  EXPECT_EXIT((own_process(), read_a_file_that_is_cut(folder / "volume.raw")), testing::ExitedWithCode(4),
              "^pendular: an input file was cut short or could not be read while it was in use\n$");
}

TEST(OwnProcess, ALibraryLeavesSignalsToItsCaller) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "volume.raw") << std::string(8192, 'x');
  // What a sanitizer does with the signal is set aside.
  EXPECT_EXIT((::signal(SIGBUS, SIG_DFL), read_a_file_that_is_cut(folder / "volume.raw")),
              testing::KilledBySignal(SIGBUS), "");
}

}  // namespace
}  // namespace pendular
