#include "tests.h"

#include "base/parallel.h"
#include "effects/list.h"

namespace pendular::effects::test {
namespace {

/// Every effect at once, each at a tenth of its bank, on a driven platen.
Sample all_at_once() {
  Sample sample = sample_a();
  sample.contact.bond_friction_limit = false;
  sample.compression.max_strain = 0.02;
  sample.compression.speed = 1e-3;
  sample.compression.frames = 0;
  for (const auto& effect : all_effects()) sample.effects[effect.id] = 0.1 * effect.bank_to;
  sample.effects["loading_rate"] = 1.5;
  return sample;
}

std::string curve_of(const Sample& sample, const fs::path& folder,
                     const dem_core::CompressOptions& options = {}) {
  compress_with_effects(disordered(3, 4), sample, 5, folder, options);
  return read_text(folder / "curve.csv") + read_text(folder / "events.csv");
}

TEST(CompressWithEffects, WithoutEffectsIsTheModel) {
  Sample sample = all_at_once();
  sample.effects.clear();
  sample.beads.diameters = Diameters::drawn;
  ScratchFolder folder;
  dem_core::compress(dem_core::realise(disordered(3, 4), sample, 5), sample, folder / "model", {});
  EXPECT_EQ(curve_of(sample, folder / "run"),
            read_text(folder / "model" / "curve.csv") + read_text(folder / "model" / "events.csv"));
}

TEST(CompressWithEffects, AllEffectsAtOnceGiveTheSameBitsForAnyNumberOfThreads) {
  ScratchFolder folder;
  set_threads(1);
  const std::string alone = curve_of(all_at_once(), folder / "one");
  set_threads(4);
  EXPECT_EQ(curve_of(all_at_once(), folder / "four"), alone);
  set_threads(0);
}

TEST(CompressWithEffects, GoesOnFromACheckpointAsIfNeverStopped) {
  ScratchFolder folder;
  Sample sample = all_at_once();
  sample.compression.rows_per_strain = 100.0;
  dem_core::CompressOptions options;
  options.checkpoint_every = 0.0;  // after every row: of the first of two, and at the end
  const std::string whole = curve_of(sample, folder / "run", options);
  fs::remove(folder / "run" / "checkpoint");
  ASSERT_TRUE(fs::exists(folder / "run" / "checkpoint.previous"));
  options.resume = true;
  EXPECT_EQ(curve_of(sample, folder / "run", options), whole);
}

TEST(CompressWithEffects, WorkBalances) {
  Sample sample = all_at_once();
  sample.effects.erase("machine_compliance");
  ScratchFolder folder;
  const auto done = compress_with_effects(disordered(3, 4), sample, 5, folder / "run", {});
  EXPECT_LT(std::fabs(work_error(done)), 2e-3);
}

}  // namespace
}  // namespace pendular::effects::test
