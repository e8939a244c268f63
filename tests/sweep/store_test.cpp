#include "sweep/store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "base/error.h"
#include "scratch.h"

namespace pendular::sweep {
namespace {

using test::ScratchFolder;

RunRequest request_of(std::uint64_t seed) {
  RunRequest request;
  request.seed = seed;
  return request;
}

/// Lets another process work on the store and die without a word.
void in_a_process_that_is_killed(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
}

/// What make_run() leaves for a run that is done.
void plant_done(Store& store, const RunRequest& request) {
  const std::string hash = content_hash(request);
  make_folder(store.run_folder(hash));
  write_text(store.run_folder(hash) / "request.json", request_text(request));
  store.finish(hash, Effort{1e6, 0.5, 2});
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const pendular::BadInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Store, ARunIsTakenOnceAndAgainWhereItsWorkerIsDead) {
  ScratchFolder folder;
  Store store(folder / "store");
  const std::string hash = store.add(std::vector{request_of(1)})[0];
  in_a_process_that_is_killed([&] { Store(folder / "store").take(hash); });
  EXPECT_EQ(store.record(hash).status, RunStatus::running);
  EXPECT_FALSE(store.record(hash).worker_alive);
  EXPECT_TRUE(store.take(hash)) << "its worker is dead";
  EXPECT_FALSE(store.take(hash)) << "this process makes it";
  EXPECT_TRUE(store.record(hash).worker_alive);
  store.give_back(hash);
  EXPECT_TRUE(store.take(hash));
  store.finish(hash, std::nullopt);
  EXPECT_FALSE(store.take(hash));
}

TEST(Store, ASilentWorkerOnAnotherHostIsGivenUp) {
  EXPECT_TRUE(alive({"elsewhere", 1, 1}, 20.0));
  EXPECT_FALSE(alive({"elsewhere", 1, 1}, 1000.0));
  const WorkerId me = this_worker();
  EXPECT_TRUE(alive(me, 1000.0)) << "seen to live";
  EXPECT_FALSE(alive({me.host, me.pid, me.started + 1}, 0.0)) << "an earlier process of the same number";
}

TEST(Store, AFailedRunIsTakenAgainOnlyWhenAskedFor) {
  ScratchFolder folder;
  Store store(folder / "store");
  const std::string hash = store.add(std::vector{request_of(1)})[0];
  ASSERT_TRUE(store.take(hash));
  store.fail(hash, 4, "diverged, \"badly\"");
  store.add(std::vector{request_of(1)});
  EXPECT_FALSE(store.take(hash));
  EXPECT_EQ(store.record(hash).exit_status, 4);
  EXPECT_EQ(store.record(hash).message, "diverged, \"badly\"");
  store.retry(hash);
  EXPECT_TRUE(store.take(hash));
}

TEST(Store, ALostIndexIsMadeAnewFromTheRunFolders) {
  ScratchFolder folder;
  std::vector<std::string> hashes;
  {
    Store store(folder / "store");
    hashes = store.add(std::vector{request_of(1), request_of(2), request_of(3)});
    plant_done(store, request_of(1));
    store.fail(hashes[1], 3, "no bridge");
  }
  fs::remove(folder / "store" / "index.sqlite");
  Store store(folder / "store");
  EXPECT_EQ(store.record(hashes[0]).status, RunStatus::done);
  EXPECT_EQ(store.record(hashes[1]).status, RunStatus::failed);
  EXPECT_EQ(store.record(hashes[1]).message, "no bridge");
  EXPECT_EQ(store.records(hashes).size(), 2u) << "the third was never begun";
  EXPECT_EQ(request_text(store.request(hashes[0])), request_text(request_of(1)));
}

TEST(Store, ARunWhoseFolderHasGoneWaitsAgain) {
  ScratchFolder folder;
  Store store(folder / "store");
  const std::string hash = store.add(std::vector{request_of(1)})[0];
  plant_done(store, request_of(1));
  store.add(std::vector{request_of(1)});
  EXPECT_EQ(store.record(hash).status, RunStatus::done);
  fs::remove_all(store.run_folder(hash));
  store.add(std::vector{request_of(1)});
  EXPECT_EQ(store.record(hash).status, RunStatus::waiting);
}

TEST(Store, RateIsThatOfOneThread) {
  ScratchFolder folder;
  Store store(folder / "store");
  EXPECT_FALSE(store.rate());
  store.add(std::vector{request_of(1)});
  plant_done(store, request_of(1));
  EXPECT_DOUBLE_EQ(store.rate().value(), 1e6);
}

TEST(Store, AnotherVersionIsRefused) {
  ScratchFolder folder;
  Store(folder / "store");
  Database(folder / "store" / "index.sqlite").run("PRAGMA user_version = 99");
  EXPECT_NE(message_of([&] { Store(folder / "store"); }).find("found a store of version 99, expected 1"),
            std::string::npos);
}

TEST(Store, DamageIsTold) {
  ScratchFolder folder;
  Store(folder / "store");
  const fs::path index = folder / "store" / "index.sqlite";
  const std::string good = read_text(index);
  write_text(index, "this is no index, and long enough to be taken for one by its length alone");
  EXPECT_NE(message_of([&] { Store(folder / "store"); }).find("is damaged; remove it"), std::string::npos);
  std::string bad = good;
  for (std::size_t k = 4096; k < bad.size(); ++k) bad[k] = '\x55';
  write_text(index, bad);
  EXPECT_NE(message_of([&] { Store(folder / "store"); }).find("is damaged; remove it"), std::string::npos);
}

TEST(Store, ManyProcessesTakeEachRunOnce) {
  ScratchFolder folder;
  constexpr int kRuns = 40, kProcesses = 4;
  std::vector<RunRequest> requests;
  for (int k = 0; k < kRuns; ++k) requests.push_back(request_of(static_cast<std::uint64_t>(k)));
  std::vector<pid_t> children;
  for (int p = 0; p < kProcesses; ++p) {
    const pid_t child = ::fork();
    if (child == 0) {
      Store store(folder / "store");
      const auto hashes = store.add(requests);
      for (std::size_t k = 0; k < hashes.size(); ++k)
        if (store.take(hashes[k])) {
          write_text(folder / (hashes[k] + "." + std::to_string(::getpid())), "taken");
          plant_done(store, requests[k]);
        }
      ::_exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  int taken = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) taken += entry.path().filename() != "store";
  EXPECT_EQ(taken, kRuns);
}

}  // namespace
}  // namespace pendular::sweep
