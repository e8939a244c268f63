#include "mutation.h"

#include "packing/bridges.h"
#include "packing/exchange.h"
#include "packing/tables.h"
#include "packing/vtp.h"
#include "scratch.h"
#include "small_packing.h"

namespace pendular {
namespace {

using test::read_mutations;
using test::ScratchFolder;

TEST(Mutation, NoDamageToAPackingCrashesItsReaders) {
  ScratchFolder folder;
  const Packing packing = test::small_packing();
  write_packing(folder / "p.vtp", packing);
  read_mutations(folder / "p.vtp", read_text(folder / "p.vtp"), 300,
                 [](const fs::path& path) { read_packing(path); });
  write_beads(folder / "b.csv", packing.beads, {});
  read_mutations(folder / "b.csv", read_text(folder / "b.csv"), 300,
                 [](const fs::path& path) { read_beads(path); });
  write_bridges(folder / "g.csv", packing.beads, packing.bridges, {});
  read_mutations(folder / "g.csv", read_text(folder / "g.csv"), 300,
                 [&](const fs::path& path) { read_bridges(path, packing.beads); });
  for (const auto format : {ExchangeFormat::yade, ExchangeFormat::lammps, ExchangeFormat::liggghts}) {
    write_exchange(folder / "x", format, packing, 2500.0);
    read_mutations(folder / "x", read_text(folder / "x"), 300,
                   [&](const fs::path& path) { read_exchange(path, format, 2e-4); });
  }
}

}  // namespace
}  // namespace pendular
