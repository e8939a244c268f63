#include "base/files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::ScratchFolder;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Files, Sha256OfKnownText) {
  // FIPS 180-2, example B.1.
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  ScratchFolder folder;
  write_text(folder / "abc", "abc");
  EXPECT_EQ(sha256_of(folder / "abc"), sha256("abc"));
}

TEST(Files, WrittenWholeOrNotAtAll) {
  ScratchFolder folder;
  write_text(folder / "a.txt", "first");
  EXPECT_THROW(write_atomically(folder / "a.txt",
                                [](const fs::path& temporary) {
                                  std::ofstream(temporary) << "half";
                                  throw std::runtime_error("stopped half-way");
                                }),
               ComputationFailed);
  EXPECT_EQ(read_text(folder / "a.txt"), "first");
  EXPECT_EQ(entries(folder.path()), 1u) << "a temporary file is left";
}

TEST(Files, FullDiscIsSaid) {
  // /dev/full takes a write and then has no space: what a stream notices at its end.
  EXPECT_THROW(write_atomically(ScratchFolder() / "x",
                                [](const fs::path& temporary) {
                                  fs::create_symlink("/dev/full", temporary);
                                  std::ofstream out(temporary);
                                  out << "text";
                                  out.close();
                                  if (!out) throw ComputationFailed("no space");
                                }),
               ComputationFailed);
}

TEST(Files, FolderWhereAFileIs) {
  ScratchFolder folder;
  write_text(folder / "file", "");
  EXPECT_THROW(make_folder(folder / "file"), BadInput);
  EXPECT_THROW(make_folder(folder / "file" / "below"), BadInput);
  EXPECT_THROW(write_text(folder.path(), "text"), BadInput);
  EXPECT_THROW(read_text(folder / "absent"), BadInput);
  EXPECT_THROW(write_text(folder / "absent" / "file", "text"), ComputationFailed);
}

}  // namespace
}  // namespace pendular
