#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/files.h"

namespace pendular {

/// Where an output comes from. Holds nothing that differs between two runs of the same work (no time,
/// no thread count, no output path), so that equal work gives equal bytes.
struct Provenance {
  std::string version;
  std::string
      command;  ///< as typed, without what cannot change the result (--threads, --quiet, --out, --resume)
  std::uint64_t seed = 0;
  struct Input {
    std::string path;
    std::string sha256;
  };
  std::vector<Input> inputs;

  void add_input(const fs::path& path);
};

/// `git describe` of the sources, or the project's version where they are no repository. Hashes have
/// kModelVersion in its place (base/model_version.h).
std::string program_version();

/// {"version":…, "command":…, "seed":…, "inputs":[{"path":…,"sha256":…}]}
nlohmann::ordered_json to_json(const Provenance& provenance);
Provenance provenance_from_json(const nlohmann::json& json);

/// The same as comment lines ("# …\n") for the head of a CSV file.
std::string to_comment(const Provenance& provenance);

}  // namespace pendular
