#include "mutation.h"
#include "places.h"

#include "base/csv.h"
#include "base/sample.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::read_mutations;
using test::ScratchFolder;

TEST(Mutation, NoDamageToTextCrashesItsReaders) {
  ScratchFolder folder;
  read_mutations(folder / "s.toml",
                 read_text(fs::path(pendular::test::source_folder()) / "samples" / "demo.toml"), 500,
                 [](const fs::path& path) { read_sample(path); });
  read_mutations(folder / "t.csv", "# comment\na,b,\"c\"\n1,2,3\n4.5,-6e3,7\n", 500,
                 [](const fs::path& path) {
                   const CsvTable table = read_csv(path, {"a", "b"});
                   table.numbers("a");
                   table.integers("b");
                 });
}

}  // namespace
}  // namespace pendular
