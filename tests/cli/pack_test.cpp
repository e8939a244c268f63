#include <gtest/gtest.h>

#include "packing/tables.h"
#include "packing/vtp.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::ScratchFolder;
using test::shell;

/// What `pack` says of the packing's beads, with lengths and widths measured too large by these shares.
std::string said_of(const ScratchFolder& folder, double lengths, double widths) {
  std::vector<Bead> beads = read_packing(folder / "p.vtp").beads;
  for (Bead& bead : beads) bead.centre *= lengths, bead.diameter *= widths;
  write_beads(folder / "beads.csv", beads, {});
  const auto done = shell(folder.path(), "$P pack beads.csv --sample s.toml -o q.vtp");
  EXPECT_EQ(done.status, 0) << done.errors;
  return done.errors;
}

TEST(Pack, SaysWhereTheVoxelSizeOrTheDiametersLookWrong) {
  const ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp").status, 0);
  EXPECT_EQ(said_of(folder, 1.0, 1.0).find("may be"), std::string::npos) << said_of(folder, 1.0, 1.0);
  EXPECT_NE(said_of(folder, 1.06, 1.06).find("the voxel size may be 1.0"), std::string::npos);
  EXPECT_NE(said_of(folder, 1.0, 0.95).find("diameters may be biased"), std::string::npos);
}

}  // namespace
}  // namespace pendular
