#include <gtest/gtest.h>

#include <map>

#include "base/error.h"
#include "base/interrupt.h"
#include "dem_core/compress.h"
#include "run_folder/run_folder.h"
#include "scratch.h"
#include "specimens.h"

namespace pendular::dem_core {
namespace {

using test::disordered;
using test::sample_a;
using test::ScratchFolder;

/// Tests of one specimen with other numbers, each into a folder of its own.
std::vector<CompressTask> tasks_in(const fs::path& folder, std::size_t size) {
  std::vector<CompressTask> tasks;
  for (std::size_t n = 0; n < size; ++n) {
    CompressTask task = {disordered(2, 3), sample_a(), folder / std::to_string(n), {}};
    task.sample.compression.max_strain = 0.012 + 0.001 * static_cast<double>(n % 3);
    task.sample.compression.unload_at = {0.006};
    task.sample.compression.frames = 2;
    task.sample.contact.friction = 0.5 - 0.02 * static_cast<double>(n);
    task.sample.bridges.interfacial_energy = 0.01;
    task.options.prepare = [n](Simulation& simulation) {
      for (auto& pair : simulation.pairs) pair.properties.kn *= 1.0 - 0.01 * static_cast<double>(n);
    };
    if (n == 2) task.options.evolution.change = [](const BondMoment& bond) { bond.properties.kn *= 0.9999; };
    tasks.push_back(task);
  }
  return tasks;
}

/// All but the checkpoint before the last.
std::map<std::string, std::string> bytes(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().extension() == ".previous") continue;
    std::string text = read_text(entry.path());
    if (entry.path().filename() == run_file::kResult) {
      auto json = nlohmann::ordered_json::parse(text);
      json.erase("performance");
      text = json.dump();
    }
    found[entry.path().lexically_relative(folder).string()] = text;
  }
  return found;
}

TEST(CompressSideBySide, WritesTheBytesOfEachAlone) {
  ScratchFolder folder;
  const auto alone = tasks_in(folder / "alone", 8), together = tasks_in(folder / "together", 8);
  std::map<std::size_t, double> modulus;
  compress_side_by_side(together, [&](std::size_t task, const CompressOutcome& outcome) {
    ASSERT_TRUE(outcome.result.has_value()) << task;
    modulus[task] = outcome.result->rows.back().stress;
  });
  EXPECT_EQ(modulus.size(), 8u);
  for (std::size_t n = 0; n < alone.size(); ++n) {
    const auto result = compress(alone[n]);
    EXPECT_EQ(result.rows.back().stress, modulus[n]);
    EXPECT_GT(result.rows.back().broken_bonds, 5.0) << "bonds should break";
    const auto expected = bytes(alone[n].folder), found = bytes(together[n].folder);
    EXPECT_GT(expected.size(), 5u);
    EXPECT_EQ(expected, found) << n;
  }
}

TEST(CompressSideBySide, OneThatFailsOrDoesNotSuitIsNoneOfTheOthersBusiness) {
  ScratchFolder folder;
  auto tasks = tasks_in(folder.path(), 5);
  tasks[1].sample.contact.time_step_fraction = 0.5;
  tasks[1].sample.contact.damping_fraction = 1.0;  // diverges
  tasks[2].packing = disordered(2, 4);             // another specimen
  tasks[3].packing.bridges.clear();                // nothing to compress
  tasks[4].sample.compression.control = Control::relaxation;
  std::map<std::size_t, CompressOutcome> outcomes;
  compress_side_by_side(tasks,
                        [&](std::size_t task, const CompressOutcome& outcome) { outcomes[task] = outcome; });
  EXPECT_TRUE(outcomes.at(0).result.has_value());
  EXPECT_THROW(std::rethrow_exception(outcomes.at(1).error), ComputationFailed);
  EXPECT_THROW(std::rethrow_exception(outcomes.at(3).error), BadInput);
  EXPECT_EQ(outcomes.size(), 3u) << "two do not suit";
  const auto alone = tasks_in(folder / "alone", 1);
  compress(alone[0]);
  EXPECT_EQ(bytes(alone[0].folder), bytes(tasks[0].folder));

  for (const std::size_t n : {2, 4}) {
    bool made = false;  // the first one is in any case
    compress_side_by_side(std::span(tasks).subspan(n, 1), [&](std::size_t, const CompressOutcome& outcome) {
      made = outcome.result.has_value();
    });
    EXPECT_TRUE(made) << n;
  }
}

TEST(CompressSideBySide, InterruptedGoesOnToTheSameBytes) {
  ScratchFolder folder;
  const auto alone = tasks_in(folder / "alone", 3);
  for (const auto& task : alone) compress(task);
  auto tasks = tasks_in(folder / "together", 3);
  for (auto& task : tasks) task.options.resume = true;
  int steps = 0;
  tasks[2].options.evolution.change = [&](const BondMoment& bond) {
    bond.properties.kn *= 0.9999;
    if (++steps == 8000) ask_to_stop();
  };
  std::size_t ended = 0;
  const auto count = [&](std::size_t, const CompressOutcome& outcome) {
    ended += outcome.result.has_value();
  };
  EXPECT_THROW(compress_side_by_side(tasks, count), Interrupted);
  go_on();
  EXPECT_EQ(ended, 0u);
  EXPECT_FALSE(fs::exists(tasks[0].folder / run_file::kCurve));
  compress_side_by_side(tasks, count);
  EXPECT_EQ(ended, 3u);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(bytes(alone[n].folder), bytes(tasks[n].folder)) << n;
  }
}

}  // namespace
}  // namespace pendular::dem_core
