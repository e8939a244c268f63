#include "mutation.h"

#include "scratch.h"
#include "sweep/plan.h"
#include "sweep_files.h"

namespace pendular::sweep {
namespace {

using test::read_mutations;
using test::ScratchFolder;

TEST(Mutation, NoDamageToASweepFileCrashesItsReader) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::tiny_sample());
  read_mutations(folder / "sweep.toml",
                 "[sweep]\nname = \"E against E_p\"\nsample = \"s.toml\"\nseed = 1\nrealisations = 5\n"
                 "keep = \"curve\"\npackings = \"one\"\n[grid]\n\"bridges.youngs_modulus_pa\" = [1e5, 1e6]\n"
                 "W = [0.01, 0.02]\nbridges.stiffness = [\"one\"]\n[[list]]\n\"bridges.gap_um\" = [1, 2]\n"
                 "compression.unload_at = [0.05, 0.06]\n",
                 500, [](const fs::path& path) { read_sweep(path); });
}

TEST(Mutation, NoDamageToARequestCrashesItsReader) {
  ScratchFolder folder;
  RunRequest request;
  read_mutations(folder / "request.json", request_text(request), 500,
                 [](const fs::path& path) { parse_request(read_text(path), path.string()); });
}

}  // namespace
}  // namespace pendular::sweep
