#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dem_core/observe/curve.h"
#include "packing/packing.h"

namespace pendular::python {

namespace py = pybind11;

/// Fields of the structured arrays, SI, with units in their names. They lie in memory as the library's own
/// structs do.
py::dtype bead_fields();
py::dtype bridge_fields();
py::dtype curve_fields();

/// A read-only array over memory that `owner` keeps.
py::array view_of(const void* first, const py::dtype& fields, const std::vector<py::ssize_t>& shape,
                  py::handle owner);

/// An array that owns the values.
template <typename T>
py::array records(std::vector<T> values, const py::dtype& fields) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* held) { delete static_cast<std::vector<T>*>(held); });
  py::array array(fields, {static_cast<py::ssize_t>(kept->size())}, {static_cast<py::ssize_t>(sizeof(T))},
                  kept->data(), owner);
  return array;
}

/// Beads from a structured array; lengths from the fields ..._m, or ..._um. BadInput, opening with
/// `argument`, for another kind of array, a missing field, and as check_beads().
std::vector<Bead> beads_from(const py::object& array, const std::string& argument);

/// Bridges of `beads`, whose places they name, sorted; the same. None: no bridges.
std::vector<Bridge> bridges_from(const py::object& array, const std::vector<Bead>& beads,
                                 const std::string& argument);

}  // namespace pendular::python
