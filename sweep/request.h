#pragma once

#include <cstdint>
#include <string>

#include "base/files.h"
#include "base/sample.h"

namespace pendular::sweep {

/// Where the beads of a run come from: a file, known by what is in it, or a seed.
struct PackingSource {
  std::string sha256;          ///< of the file; empty: generated from the sample
  std::uint64_t seed = 1;      ///< of the generated packing
  fs::path file;               ///< where the file lies now
  std::size_t beads = 0;       ///< in the file; 0: not known
  bool errors_stated = false;  ///< of these beads
};

/// A packing file; BadInput where it is none.
PackingSource packing_file(const fs::path& path);
PackingSource generated_packing(std::uint64_t seed);

/// One compression test, stated in full. Diameters are drawn anew with `seed` where the sample asks for it.
struct RunRequest {
  Sample sample;
  PackingSource packing;
  std::uint64_t seed = 1;
  bool keep_all = false;  ///< frames and checkpoint too; else frames only where frame_at names their strains
};

/// The request as JSON text: the same for equal requests, whatever machine, folder or file name; with the
/// model's version (base/model_version.h). The sample that counts is what this text tells (see
/// sample_settings()).
std::string request_text(const RunRequest& request);

/// Reads such a text; `file` and `beads` of the packing stay empty. BadInput, opening with `where`.
RunRequest parse_request(const std::string& text, const std::string& where);

/// The name of a run: SHA-256 of its text.
std::string content_hash(const RunRequest& request);

/// The name of a request's packing before diameters are drawn: SHA-256 of the file, or of what the generated
/// beads follow from.
std::string packing_hash(const RunRequest& request);

}  // namespace pendular::sweep
