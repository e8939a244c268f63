#include "cli/own_program.h"

namespace pendular::cli {

fs::path own_program() {
  const fs::path self = "/proc/self/exe";  // holds also where its file has been replaced
  const fs::path name = fs::read_symlink(self);
  return name.filename() == "pendular-pictures" ? name.parent_path() / "pendular" : self;
}

}  // namespace pendular::cli
