#pragma once

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <string>
#include <vector>

#include "base/files.h"
#include "base/provenance.h"
#include "base/sample.h"
#include "packing/packing.h"

namespace pendular::python {

/// A sample and where it comes from: a file, or "sample" where it was made in Python.
struct NamedSample {
  Sample sample;
  std::string name = "sample";
  bool of_file = false;
};

/// What an output comes from, as Python knows it: the call as it would be typed again, its seed, and files or
/// values by their hashes.
struct Origin {
  std::string call;
  std::uint64_t seed = 1;
  std::vector<Provenance::Input> inputs;
};
Provenance provenance_of(const Origin& origin);

/// Keeps the files among its inputs from being written to (protect_inputs()).
void protect_inputs_of(const Origin& origin);

/// Their content, by SHA-256: of the file, or of the values.
Provenance::Input input_of(const fs::path& file);
Provenance::Input input_of(const NamedSample& sample);
Provenance::Input input_of(const Packing& packing);

}  // namespace pendular::python
