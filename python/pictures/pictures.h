#pragma once

#include <pybind11/pybind11.h>

namespace pendular::python {

namespace py = pybind11;

// What needs ITK, OpenCV or VTK. Each adds its part to the module.
void add_volumes(py::module_& module);
void add_segmentation(py::module_& module);
void add_pictures(py::module_& module);
void add_diagnosis(py::module_& module);

}  // namespace pendular::python
