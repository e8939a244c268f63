#include "binding/work.h"
#include "pictures/pictures.h"

PYBIND11_MODULE(_pictures, module) {
  using namespace pendular::python;
  py::module_::import("pendular._core");
  translate_errors();
  add_volumes(module);
  add_segmentation(module);
  add_pictures(module);
  add_diagnosis(module);
}
