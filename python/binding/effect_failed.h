#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "base/error.h"

namespace pendular::python {

namespace py = pybind11;

/// A Python object that any thread may let go.
inline std::shared_ptr<py::object> shared(py::object object) {
  return {new py::object(std::move(object)), [](py::object* held) {
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

/// An effect written in Python failed; knows the exception.
class EffectFailed : public ComputationFailed {
 public:
  EffectFailed(const std::string& message, std::shared_ptr<py::object> cause)
      : ComputationFailed(message), cause_(std::move(cause)) {}
  py::object cause() const { return cause_ ? *cause_ : py::none(); }

 private:
  std::shared_ptr<py::object> cause_;
};

}  // namespace pendular::python
