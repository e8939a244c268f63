#include "base/files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "base/path_kind.h"
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

TEST(Files, WhatCannotBeSeenIsSaid) {
  ScratchFolder folder;
  fs::create_symlink("circle", folder / "circle");
  fs::create_symlink("nowhere", folder / "dangling");
  write_text(folder / "file", "");
  EXPECT_TRUE(is_file(folder / "file") && is_folder(folder.path()) && is_there(folder / "file"));
  EXPECT_FALSE(is_there(folder / "dangling") || is_file(folder.path()) || is_folder(folder / "file/below"));
  for (const fs::path& unseen :
       {folder / "circle", folder / "circle" / "below", folder / std::string(300, 'x')}) {
    EXPECT_THROW(is_there(unseen), BadInput);
    EXPECT_THROW(is_file(unseen), BadInput);
    EXPECT_THROW(is_folder(unseen), BadInput);
    EXPECT_THROW(require_readable(unseen), BadInput);
    EXPECT_THROW(make_folder(unseen), BadInput);
  }
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

TEST(Files, InputsAreNeitherWrittenNorRemovedUnderAnyName) {
  ScratchFolder folder;
  write_text(folder / "in.txt", "input");
  write_text(folder / "slices.txt", "no slice");
  fs::create_directory(folder / "slices");
  write_text(folder / "slices" / "1.tif", "slice");
  fs::create_symlink("in.txt", folder / "link.txt");
  fs::create_hard_link(folder / "in.txt", folder / "hard.txt");
  protect_inputs({folder / "in.txt", folder / "slices" / "1.tif", ""});
  for (const char* name : {"in.txt", "link.txt", "hard.txt", "slices/1.tif", "slices/../in.txt"}) {
    EXPECT_THROW(write_text(folder / name, "output"), BadUsage) << name;
    EXPECT_THROW(require_writable(folder / name), BadUsage) << name;
    EXPECT_THROW(require_outputs({folder / name}), BadUsage) << name;
    EXPECT_THROW(remove_output(folder / name), BadUsage) << name;
  }
  EXPECT_EQ(read_text(folder / "in.txt"), "input");
  protect_inputs({});
  write_text(folder / "in.txt", "output");
}

TEST(Files, EachOutputIsAFileOfItsOwn) {
  ScratchFolder folder;
  write_text(folder / "a.csv", "");
  fs::create_symlink("a.csv", folder / "b.csv");
  EXPECT_THROW(require_outputs({folder / "new.csv", folder / "new.csv"}), BadUsage);
  EXPECT_THROW(require_outputs({folder / "new.csv", folder / "." / "new.csv"}), BadUsage);
  EXPECT_THROW(require_outputs({folder / "a.csv", folder / "b.csv"}), BadUsage);
  EXPECT_NO_THROW(require_outputs({folder / "a.csv", folder / "c.csv", "", ""}));
}

TEST(Files, DevicesAreNotReplaced) {
  ScratchFolder folder;
  for (const char* device : {"/dev/null", "/dev/full", "/proc/self/fd/1"}) {
    fs::create_symlink(device, folder / "sink");  // a failure must not replace the device itself
    EXPECT_THROW(write_text(folder / "sink", "text"), BadInput) << device;
    EXPECT_THROW(require_writable(folder / "sink"), BadInput) << device;
    EXPECT_TRUE(fs::is_symlink(folder / "sink"));
    fs::remove(folder / "sink");
  }
}

TEST(Files, WrittenTogetherOrNoneOfThem) {
  ScratchFolder folder;
  write_text(folder / "a.txt", "old");
  {
    WrittenTogether written;
    write_text(folder / "a.txt", "new");
    write_text(folder / "b.txt", "new");
    EXPECT_EQ(read_text(folder / "a.txt"), "old");
  }
  EXPECT_EQ(read_text(folder / "a.txt"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
  {
    WrittenTogether written;
    write_text(folder / "a.txt", "new");
    write_text(folder / "b.txt", "new");
    written.commit();
  }
  EXPECT_EQ(read_text(folder / "a.txt"), "new");
  EXPECT_EQ(read_text(folder / "b.txt"), "new");
  EXPECT_EQ(entries(folder.path()), 2u);
}

TEST(Files, AnInnerFolderIsNoLink) {
  ScratchFolder folder;
  fs::create_directory(folder / "elsewhere");
  fs::create_directory_symlink("elsewhere", folder / "frames");
  EXPECT_THROW(make_inner_folder(folder / "frames"), BadInput);
  EXPECT_NO_THROW(make_inner_folder(folder / "elsewhere"));
}

}  // namespace
}  // namespace pendular
