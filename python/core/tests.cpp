#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "binding/arrays.h"
#include "binding/inputs.h"
#include "binding/json.h"
#include "binding/work.h"
#include "core/core.h"
#include "dem_core/linear/linear_response.h"
#include "dem_core/linear/linear_response_json.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "packing/measurement.h"

namespace pendular::python {
namespace {

py::tuple compress(const Packing& packing, const NamedSample& sample, const fs::path& out, bool resume,
                   double checkpoint_every, const Origin& origin, const Terms& terms) {
  auto done = work(terms, [&] {
    protect_inputs_of(origin);
    effects::check_effects(sample.sample, sample.name);
    warn_of_open_contacts(packing.beads, sample.sample);
    dem_core::CompressOptions options;
    options.resume = resume;
    options.checkpoint_every = checkpoint_every;
    options.provenance = provenance_of(origin);
    return effects::compress_with_effects(packing, sample.sample, origin.seed, out, options);
  });
  return py::make_tuple(records(std::move(done.rows), curve_fields()), to_python(done.result));
}

py::object modulus(const Packing& packing, const NamedSample& sample, double strain, const Origin& origin,
                   const Terms& terms) {
  return to_python(work(terms, [&] {
    effects::check_effects(sample.sample, sample.name);
    warn_of_open_contacts(packing.beads, sample.sample);
    const auto specimen = effects::actual_specimen(packing, sample.sample, origin.seed);
    const dem_core::Simulation simulation = effects::actual_simulation(specimen);
    auto json = to_json(dem_core::linear_response(simulation, {strain}), simulation, strain);
    json["diameters"] = to_string(specimen.sample.beads.diameters);
    json["provenance"] = to_json(provenance_of(origin));
    return json;
  }));
}

}  // namespace

void add_tests(py::module_& module) {
  module.def("compress", &compress);
  module.def("modulus", &modulus);
}

}  // namespace pendular::python
