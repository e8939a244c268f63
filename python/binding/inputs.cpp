#include "binding/inputs.h"
#include "base/path_kind.h"

#include <cstring>

namespace pendular::python {
namespace {

template <typename... Values>
void append(std::string& bytes, const Values&... values) {
  const auto one = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  (one(values), ...);
}

}  // namespace

Provenance provenance_of(const Origin& origin) {
  return {program_version(), origin.call, origin.seed, origin.inputs};
}

void protect_inputs_of(const Origin& origin) {
  std::vector<fs::path> files;
  for (const auto& input : origin.inputs)
    if (is_file(input.path)) files.push_back(input.path);
  protect_inputs(files);
}

Provenance::Input input_of(const fs::path& file) {
  return {file.string(), sha256_of(file)};
}

Provenance::Input input_of(const NamedSample& sample) {
  if (sample.of_file) return input_of(fs::path(sample.name));
  return {sample.name, sha256(sample_text(sample.sample))};
}

Provenance::Input input_of(const Packing& packing) {
  std::string bytes;
  for (const Bead& b : packing.beads)
    append(bytes, b.id, b.centre.x(), b.centre.y(), b.centre.z(), b.diameter, b.sigma_centre,
           b.sigma_diameter, b.quality, b.boundary);
  for (const Bridge& b : packing.bridges)
    append(bytes, b.i, b.j, b.gap, b.sigma_gap, b.probability, b.diameter, b.sigma_diameter, b.state);
  const Specimen& s = packing.specimen;
  append(bytes, s.diameter, s.height, s.axis_x, s.axis_y, s.bottom);
  return {"packing", sha256(bytes)};
}

}  // namespace pendular::python
