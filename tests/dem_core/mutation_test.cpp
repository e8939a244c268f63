#include "mutation.h"

#include "dem_core/checkpoint.h"
#include "scratch.h"

namespace pendular::dem_core {
namespace {

TEST(Mutation, NoDamageToACheckpointIsAccepted) {
  test::ScratchFolder folder;
  RunState state;
  state.rows.resize(5);
  state.simulation.beads.position.assign(4, Vec3::Ones());
  write_checkpoint(folder / "checkpoint", state, "identity");
  const std::string good = read_text(folder / "checkpoint");
  test::read_mutations(folder / "checkpoint", good, 500, [&](const fs::path& path) {
    read_checkpoint(path, "identity");
    EXPECT_EQ(read_text(path), good) << "a damaged checkpoint was accepted";
  });
}

}  // namespace
}  // namespace pendular::dem_core
