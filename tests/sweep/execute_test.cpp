#include "sweep/execute.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/error.h"
#include "dem_core/compress.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "packing/vtp.h"
#include "places.h"
#include "scratch.h"
#include "sweep_files.h"

namespace pendular::sweep {
namespace {

using test::ScratchFolder;

ExecuteOptions with_program() {
  ExecuteOptions options;
  options.worker = {pendular::test::program(), {"sweep-run"}};
  return options;
}

RunRequest tiny_request(std::uint64_t seed) {
  RunRequest request;
  request.sample = parse_sample(test::tiny_sample(), "s.toml");
  request.packing = generated_packing(1);
  request.seed = seed;
  return request;
}

TEST(Execute, ARunIsTheOneThatCompressMakes) {
  ScratchFolder folder;
  const RunRequest request = tiny_request(4);
  Packing packing = generate_packing(request.sample, 1);
  packing.bridges =
      candidate_bridges(packing.beads, request.sample.bridges.cutoff * request.sample.beads.diameter);
  write_packing(folder / "p.vtp", packing);
  const auto direct = dem_core::compress(dem_core::realise(read_packing(folder / "p.vtp"), request.sample, 4),
                                         request.sample, folder / "run", {});

  Store store(folder / "store");
  const auto outcomes = execute(store, std::vector{request}, with_program());
  ASSERT_EQ(outcomes.size(), 1u);
  ASSERT_EQ(outcomes[0].status, RunStatus::done) << outcomes[0].message;
  const auto result = nlohmann::ordered_json::parse(read_text(outcomes[0].folder / "result.json"));
  EXPECT_EQ(result["linear_modulus_pa"], direct.result["linear_modulus_pa"]);
  EXPECT_EQ(result["work_balance"], direct.result["work_balance"]);
  EXPECT_FALSE(result.contains("performance"));
  EXPECT_FALSE(fs::exists(outcomes[0].folder / "frames"));
  EXPECT_FALSE(fs::exists(outcomes[0].folder / "checkpoint"));
  EXPECT_TRUE(store.rate().has_value());
}

TEST(Execute, EqualRequestsAreMadeOnceAndAnsweredEach) {
  ScratchFolder folder;
  Store store(folder / "store");
  RunRequest all = tiny_request(4);
  all.keep_all = true;
  std::size_t last_done = 0, total = 0;
  ExecuteOptions options = with_program();
  options.progress = [&](std::size_t done, std::size_t, std::size_t of) { last_done = done, total = of; };
  const auto outcomes = execute(store, std::vector{tiny_request(4), all, tiny_request(4)}, options);
  ASSERT_EQ(outcomes.size(), 3u);
  EXPECT_EQ(outcomes[0].hash, outcomes[2].hash);
  EXPECT_EQ(last_done, 2u);
  EXPECT_EQ(total, 2u);
  EXPECT_TRUE(fs::exists(outcomes[1].folder / "frames" / "frame_0001.vtp"));
  EXPECT_TRUE(fs::exists(outcomes[1].folder / "checkpoint"));
  EXPECT_EQ(sha256_of(store.packing_path(packing_hash(all))),
            sha256_of(store.packing_path(packing_hash(tiny_request(4)))));
}

/// A run's curve without what says where it comes from, and without its last row, which may stand for fewer
/// steps.
std::string rows_text(const fs::path& run) {
  const std::string text = read_text(run / "curve.csv");
  const std::size_t from = text.find("\nstrain,"), last = text.rfind('\n', text.size() - 2);
  return text.substr(from, last - from);
}

TEST(Execute, ARunThatGoesFartherAnswersWhereRowsSuffice) {
  ScratchFolder folder;
  Store store(folder / "store");
  RunRequest shorter = tiny_request(4);
  shorter.sample.compression.frames = 0.0;
  shorter.sample.compression.frame_at = {0.004};
  RunRequest longer = shorter;
  longer.sample.compression.max_strain = 0.02;
  const auto far = execute(store, std::vector{longer}, with_program());
  ASSERT_EQ(far[0].status, RunStatus::done) << far[0].message;

  ExecuteOptions options = with_program();
  options.rows_suffice = true;
  RunRequest slower = shorter;
  slower.sample.compression.speed *= 0.5;
  const auto answers = execute(store, std::vector{slower, shorter, longer}, options);
  EXPECT_EQ(answers[0].hash, content_hash(slower));
  EXPECT_EQ(answers[1].hash, content_hash(longer));
  EXPECT_EQ(answers[1].up_to, 0.01);
  EXPECT_EQ(answers[2].up_to, std::nullopt);
  EXPECT_FALSE(fs::exists(store.run_folder(content_hash(shorter))));

  // What the longer run is up to there is what the shorter one is, byte by byte.
  const auto made = execute(store, std::vector{shorter}, with_program());
  const std::string asked = rows_text(made[0].folder), all = rows_text(far[0].folder);
  EXPECT_GT(asked.size(), 1000u);
  EXPECT_LT(asked.size(), all.size());
  EXPECT_EQ(all.substr(0, asked.size()), asked);
  EXPECT_EQ(answers[1].folder, far[0].folder);
  EXPECT_EQ(execute(store, std::vector{shorter}, options)[0].folder, made[0].folder);
}

TEST(Execute, AProgramThatCannotDoItEndsTheLoop) {
  ScratchFolder folder;
  Store store(folder / "store");
  ExecuteOptions options;
  options.worker = {folder / "absent"};
  EXPECT_THROW(execute(store, std::vector{tiny_request(1)}, options), ComputationFailed);
  options = with_program();  // which says nothing of the run
  EXPECT_EQ(execute(store, std::vector{tiny_request(1)}, options)[0].status, RunStatus::done);

  write_text(folder / "killed", "#!/bin/sh\necho out of luck >&2\nkill -9 $$\n");
  fs::permissions(folder / "killed", fs::perms::owner_all);
  options.worker = {folder / "killed"};
  const auto outcomes = execute(store, std::vector{tiny_request(2)}, options);
  EXPECT_EQ(outcomes[0].status, RunStatus::failed);
  EXPECT_EQ(outcomes[0].exit_status, 137);
  EXPECT_NE(outcomes[0].message.find("killed by signal 9"), std::string::npos) << outcomes[0].message;
  EXPECT_NE(outcomes[0].message.find("out of luck"), std::string::npos) << outcomes[0].message;
}

/// Eight runs that can be made side by side, of which one diverges.
std::vector<RunRequest> family() {
  std::vector<RunRequest> requests;
  for (int n = 0; n < 8; ++n) {
    requests.push_back(tiny_request(4));
    requests.back().sample.contact.friction = 0.5 - 0.03 * n;
  }
  requests[3].sample.contact.time_step_fraction = 0.5;
  requests[3].sample.contact.damping_fraction = 1.0;
  return requests;
}

/// Of the processes that made a store's runs.
std::size_t logs_in(const fs::path& store) {
  std::size_t logs = 0;
  for (const auto& entry : fs::directory_iterator(store / "logs")) logs += entry.is_regular_file();
  return logs;
}

TEST(Execute, RunsSideBySideAreThoseMadeAlone) {
  ScratchFolder folder;
  Store alone(folder / "alone"), together(folder / "together"), killed(folder / "killed");
  ExecuteOptions options = with_program();
  options.cores = 8;  // one for each
  const auto expected = execute(alone, family(), options);
  options.cores = 1;
  const auto found = execute(together, family(), options);
  // A process that makes several and dies leaves them to processes of their own.
  write_text(folder / "frail",
             fmt::format("#!/bin/sh\nif [ $# -gt 5 ]; then kill -9 $$; fi\nexec '{}' \"$@\"\n",
                         pendular::test::program()));
  fs::permissions(folder / "frail", fs::perms::owner_all);
  options.worker = {folder / "frail", {"sweep-run"}};
  const auto after = execute(killed, family(), options);

  EXPECT_EQ(expected[3].status, RunStatus::failed);
  for (const auto* outcomes : {&found, &after})
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ((*outcomes)[k].status, expected[k].status) << (*outcomes)[k].message;
      EXPECT_EQ((*outcomes)[k].message, expected[k].message);
      EXPECT_EQ((*outcomes)[k].exit_status, expected[k].exit_status);
    }
  EXPECT_EQ(test::run_bytes(folder / "together"), test::run_bytes(folder / "alone"));
  EXPECT_EQ(test::run_bytes(folder / "killed"), test::run_bytes(folder / "alone"));
  // One process has made them: its log is of the first, and the one that failed has a log of its own.
  EXPECT_EQ(logs_in(folder / "together"), 2u);
}

TEST(Execute, EachKindOfRunsIsMadeSideBySideOnACoreOfItsOwn) {
  ScratchFolder folder;
  Store store(folder / "store");
  std::vector<RunRequest> requests;
  for (const auto springs : {TangentialSprings::one, TangentialSprings::two})
    for (int n = 0; n < 7; ++n) {
      requests.push_back(tiny_request(4));
      requests.back().sample.contact.tangential_springs = springs;
      requests.back().sample.contact.friction = 0.5 - 0.03 * n;
    }
  ExecuteOptions options = with_program();
  options.cores = 2;
  for (const auto& outcome : execute(store, requests, options))
    EXPECT_EQ(outcome.status, RunStatus::done) << outcome.message;
  EXPECT_EQ(logs_in(folder / "store"), 2u);
}

}  // namespace
}  // namespace pendular::sweep
