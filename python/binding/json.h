#pragma once

#include <pybind11/pybind11.h>

#include <nlohmann/json.hpp>

namespace pendular::python {

namespace py = pybind11;

/// As dicts, lists, numbers and text.
inline py::object to_python(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json.dump());
}

}  // namespace pendular::python
