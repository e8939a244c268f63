#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "base/error.h"
#include "binding/arrays.h"
#include "binding/effect_failed.h"
#include "binding/inputs.h"
#include "binding/work.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "phantom/phantom.h"
#include "pictures/pictures.h"
#include "volume/volume.h"

namespace pendular::python {
namespace {

// ---- The grey values as an array, and an array's as those of a volume: no copy is made ----

py::array grey(const py::object& self) {
  const Volume& volume = self.cast<const Volume&>();
  return with_pixels(volume, [&]<typename T>(std::span<const Grey<T>> pixels) {
    const auto n = [&](std::size_t axis) { return static_cast<py::ssize_t>(volume.size[axis]); };
    return view_of(pixels.data(), py::dtype::of<T>(), {n(2), n(1), n(0)}, self);
  });
}

[[noreturn]] void wrong_grey(const std::string& found, const char* expected) {
  bad_input("grey: found {}, expected {}", found, expected);
}

Volume::Pixels type_of(const py::array& array) {
  if (array.dtype().equal(py::dtype::of<std::uint8_t>())) return std::vector<std::uint8_t>();
  if (array.dtype().equal(py::dtype::of<std::uint16_t>())) return std::vector<std::uint16_t>();
  if (array.dtype().equal(py::dtype::of<float>())) return std::vector<float>();
  wrong_grey("dtype " + std::string(py::str(array.dtype().attr("str"))),
             "uint8, uint16 or float32 in the machine's byte order (array.astype(...))");
}

void check_layout(const py::array& array) {
  if (array.ndim() != 3) wrong_grey(fmt::format("{} dimensions", array.ndim()), "three: [z, y, x]");
  if (array.size() == 0) wrong_grey("an empty array", "at least one voxel");
  if ((array.flags() & py::array::c_style) == 0)
    wrong_grey("an array that is not contiguous with x last", "one that is (numpy.ascontiguousarray)");
}

Volume volume_of(const py::object& given, double voxel_um, const std::array<double, 3>& origin_um) {
  if (!py::isinstance<py::array>(given))
    wrong_grey(std::string(py::str(py::type::of(given).attr("__name__"))), "a NumPy array");
  const auto array = py::reinterpret_borrow<py::array>(given);
  Volume volume;
  volume.pixels = type_of(array);
  check_layout(array);
  constexpr double kLeast = 1e-3, kMost = 1e4;
  if (!(voxel_um >= kLeast && voxel_um <= kMost))
    bad_input("voxel_um: found {}, expected a size from {} to {} um", voxel_um, kLeast, kMost);
  for (std::size_t axis = 0; axis < 3; ++axis)
    volume.size[axis] = static_cast<std::size_t>(array.shape(static_cast<py::ssize_t>(2 - axis)));
  volume.spacing = 1e-6 * voxel_um;
  for (const double place : origin_um)
    if (!(std::fabs(place) <= 1e6)) bad_input("origin_um: found {}, expected places within a metre", place);
  volume.origin = 1e-6 * Vec3(origin_um[0], origin_um[1], origin_um[2]);
  volume.memory = {array.data(), [kept = shared(array)](const void*) {}};
  const py::gil_scoped_release released;
  check_pixels(volume, "grey");
  return volume;
}

ReadOptions reading(const std::optional<double>& voxel_um,
                    const std::optional<std::array<std::size_t, 3>>& size, const std::string& type) {
  ReadOptions options;
  if (voxel_um) options.spacing = 1e-6 * *voxel_um;
  if (size.has_value() == type.empty())
    throw BadUsage("read_volume: headerless data needs both size and type");
  options.raw_size = size;
  options.raw_type = type;
  return options;
}

std::pair<Volume, Packing> phantom(const NamedSample& sample, const std::optional<Packing>& shown,
                                   const Origin& origin, const Terms& terms) {
  return work(terms, [&] {
    Packing packing = shown ? *shown : generate_packing(sample.sample, origin.seed);
    if (!shown)
      packing.bridges =
          candidate_bridges(packing.beads, sample.sample.bridges.cutoff * sample.sample.beads.diameter);
    phantom::draw_neck_diameters(packing, sample.sample, origin.seed);
    packing.provenance = provenance_of(origin);
    Volume volume = phantom::make_phantom(packing, sample.sample.phantom, origin.seed);
    return std::pair(std::move(volume), std::move(packing));
  });
}

}  // namespace

void add_volumes(py::module_& module) {
  py::class_<Volume>(
      module, "Volume",
      "A tomogram of cubic voxels. Made from an array [z, y, x] of uint8, uint16 or float32, contiguous with "
      "x last, whose memory it uses; `grey` is a read-only array of its own memory. origin_um: centre of "
      "voxel (0, 0, 0) along x, y, z.")
      .def(py::init(&volume_of), py::arg("grey"), py::arg("voxel_um"),
           py::arg("origin_um") = std::array<double, 3>{})
      .def_property_readonly("grey", &grey)
      .def_property_readonly("voxel_um", [](const Volume& volume) { return 1e6 * volume.spacing; })
      .def_property_readonly("origin_um",
                             [](const Volume& volume) {
                               return py::make_tuple(1e6 * volume.origin.x(), 1e6 * volume.origin.y(),
                                                     1e6 * volume.origin.z());
                             })
      .def("write", [](const Volume& volume, const fs::path& path, const Origin& origin) {
        const py::gil_scoped_release released;
        write_volume(path, volume, provenance_of(origin));
      });
  module.def("read_volume", [](const fs::path& path, const std::optional<double>& voxel_um,
                               const std::optional<std::array<std::size_t, 3>>& size, const std::string& type,
                               const Terms& terms) {
    const ReadOptions how = reading(voxel_um, size, type);
    return work(terms, [&] { return read_volume(path, how); });
  });
  module.def("phantom", &phantom);
}

}  // namespace pendular::python
