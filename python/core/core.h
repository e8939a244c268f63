#pragma once

#include <pybind11/pybind11.h>

namespace pendular::python {

namespace py = pybind11;

// Each adds a part of the library to the module; docstrings are those of the Python functions that call it.
void add_samples(py::module_& module);
void add_packings(py::module_& module);
void add_bridge_stiffness(py::module_& module);
void add_tests(py::module_& module);
void add_sweeps(py::module_& module);
void add_tracking(py::module_& module);
void add_effects(py::module_& module);

}  // namespace pendular::python
