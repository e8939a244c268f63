#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "base/files.h"
#include "sample_file.h"

namespace pendular::test {

/// A sample of about a hundred beads, whose compression takes a fraction of a second.
inline std::string tiny_sample(const std::string& compression = "max_strain = 0.01\nframes = 1\n",
                               const std::string& more = "") {
  return sample_file(
      "[bridges]\nnormal_stiffness_n_per_m = 5760\ntangential_stiffness_n_per_m = 325\n"
      "[specimen]\ndiameter_um = 1000\nheight_um = 1000\nvolume_fraction = 0.53\n"
      "[compression]\n" +
      compression + more);
}

/// Writes s.toml and sweep.toml; `rest` follows the head of the sweep file.
inline void write_sweep(const fs::path& folder, const std::string& rest,
                        const std::string& sample = tiny_sample()) {
  write_text(folder / "s.toml", sample);
  write_text(folder / "sweep.toml", "[sweep]\nname = \"test\"\nsample = \"s.toml\"\n" + rest);
}

/// Hashes of all runs' files, by path below the store: what must not depend on how they were made.
inline std::string run_bytes(const fs::path& store) {
  std::string text;
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(store / "runs"))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) text += fs::relative(file, store).string() + ' ' + sha256_of(file) + '\n';
  return text;
}

}  // namespace pendular::test
