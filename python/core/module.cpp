#include "core/core.h"

#include <pybind11/stl.h>

#include "base/provenance.h"
#include "binding/inputs.h"
#include "binding/work.h"

namespace pendular::python {
namespace {

void add_terms(py::module_& module) {
  py::class_<Terms>(module, "Terms")
      .def(py::init<py::object, int>(), py::arg("progress"), py::arg("threads"));
  py::class_<Provenance::Input>(module, "Input")
      .def_readonly("path", &Provenance::Input::path)
      .def_readonly("sha256", &Provenance::Input::sha256);
  py::class_<Origin>(module, "Origin")
      .def(py::init<std::string, std::uint64_t, std::vector<Provenance::Input>>(), py::arg("call"),
           py::arg("seed"), py::arg("inputs"));
  module.def("input_of_file", [](const fs::path& file) { return input_of(file); });
}

}  // namespace
}  // namespace pendular::python

PYBIND11_MODULE(_core, module) {
  using namespace pendular::python;
  translate_errors();
  module.attr("version") = pendular::program_version();
  add_terms(module);
  add_samples(module);
  add_packings(module);
  add_bridge_stiffness(module);
  add_tests(module);
  add_sweeps(module);
  add_tracking(module);
  add_effects(module);
}
