#include "base/process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "base/error.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::ScratchFolder;

Command shell(const std::string& text) {
  return {"sh", {"-c", text}};
}

TEST(Process, StatusIsTheProgramsOrThatOfTheSignal) {
  EXPECT_EQ(run(shell("exit 7")), 7);
  EXPECT_EQ(run(shell("kill -9 $$")), 137);
  EXPECT_EQ(run({"no-such-program-anywhere"}), kCannotBeStarted);
  EXPECT_EQ(run({"/no/such/program"}), kCannotBeStarted);
}

TEST(Process, WhatItSaysGoesToItsLogOrNowhere) {
  const ScratchFolder folder;
  const fs::path log = folder / "log.txt";
  write_text(log, "of an earlier one\n");
  EXPECT_EQ(run(shell("echo out; echo err >&2"), {.log = log}), 0);
  EXPECT_EQ(read_text(log), "out\nerr\n");
  EXPECT_EQ(last_line(log), "err");
  EXPECT_EQ(last_line(folder / "absent"), "");
  EXPECT_THROW(run(shell("true"), {.log = folder / "absent" / "log.txt"}), ComputationFailed);
}

TEST(Process, WorksInItsFolderWithoutInputAndGetsTheDescriptorHanded) {
  const ScratchFolder folder;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  EXPECT_EQ(
      run(shell("pwd >here; cat >input; echo handed >&3"), {.folder = folder.path(), .handed = ends[1]}), 0);
  char text[16] = {};
  EXPECT_EQ(::read(ends[0], text, sizeof text), 7);
  EXPECT_STREQ(text, "handed\n");
  ::close(ends[0]), ::close(ends[1]);
  EXPECT_EQ(read_text(folder / "here"), fs::canonical(folder.path()).string() + "\n");
  EXPECT_EQ(read_text(folder / "input"), "");
}

TEST(Process, WordsArriveAsTheyAre) {
  const auto said = ask(Command{"printf", {"%s|"}}.with({"a b", "", "$HOME", "'\""}));
  EXPECT_EQ(said.text, "a b||$HOME|'\"|");
  EXPECT_EQ(said.status, 0);
  EXPECT_EQ(ask(shell("echo out; echo err >&2; exit 3")).text, "out\nerr\n");
  EXPECT_EQ(ask(shell("exit 3")).status, 3);
}

TEST(Process, IsEndedWhereItIsLeftAndMayKeepWhatItHas) {
  const ScratchFolder folder;
  {
    Process process(shell("trap 'echo kept >kept; exit 0' TERM; echo >ready; while :; do sleep 0.01; done"),
                    {.folder = folder.path()});
    while (!fs::exists(folder / "ready")) ::usleep(1000);
    EXPECT_FALSE(process.ended());
  }
  EXPECT_EQ(read_text(folder / "kept"), "kept\n");
}

TEST(RunApart, ComesBackWithWhatWasReturnedAndSurvivesTheCopy) {
  int here = 1;
  const auto said = run_apart([&] {
    here = 2;
    return std::string(100000, 'x');
  });
  EXPECT_EQ(said.text, std::string(100000, 'x'));
  EXPECT_EQ(said.status, 0);
  EXPECT_EQ(here, 1);
  EXPECT_EQ(run_apart([]() -> std::string {
              std::raise(SIGKILL), ::pause();
              return "";
            }).status,
            137);
  EXPECT_EQ(run_apart([]() -> std::string { throw BadInput("lost"); }).status, 1);
}

}  // namespace
}  // namespace pendular
