#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "binding/arrays.h"
#include "binding/inputs.h"
#include "binding/json.h"
#include "binding/work.h"
#include "core/core.h"
#include "packing/check.h"
#include "packing/exchange.h"
#include "packing/pack.h"
#include "packing/polydata.h"
#include "packing/statistics.h"
#include "packing/tables.h"
#include "packing/vtp.h"

namespace pendular::python {
namespace {

/// A packing and what `pack` found of it.
struct PackedWithReport {
  Packing packing;
  nlohmann::ordered_json report;
};

PackedWithReport with_report(Packed packed) {
  auto report = to_json(packed);
  return {std::move(packed.packing), std::move(report)};
}

PackedWithReport pack(const py::object& beads, const py::object& bridges, const NamedSample& sample,
                      const Origin& origin, const Terms& terms) {
  const auto measured = beads_from(beads, "beads");
  std::optional<std::vector<Bridge>> joined;
  if (!bridges.is_none()) joined = bridges_from(bridges, measured, "bridges");
  return work(terms, [&] {
    Packed packed = pack_beads(measured, joined, sample.sample, {"beads", "bridges", sample.name});
    packed.packing.provenance = provenance_of(origin);
    return with_report(std::move(packed));
  });
}

PackedWithReport generate(const NamedSample& sample, const Origin& origin, const Terms& terms) {
  return work(terms, [&] {
    Packed packed = pack_generated(sample.sample, origin.seed);
    packed.packing.provenance = provenance_of(origin);
    return with_report(std::move(packed));
  });
}

Packing make_packing(const py::object& beads, const py::object& bridges,
                     const std::optional<Specimen>& specimen) {
  Packing packing;
  packing.beads = beads_from(beads, "beads");
  packing.bridges = bridges_from(bridges, packing.beads, "bridges");
  packing.specimen = specimen.value_or(specimen_enclosing(packing.beads));
  return packing;
}

/// The result of a call without the interpreter's lock.
template <typename Call>
auto unlocked(const Call& call) {
  const py::gil_scoped_release released;
  return call();
}

template <typename T>
py::array part(const py::object& self, const std::vector<T>& values, const py::dtype& fields) {
  return view_of(values.data(), fields, {static_cast<py::ssize_t>(values.size())}, self);
}

void add_specimen(py::module_& module) {
  py::class_<Specimen>(module, "Specimen", "The upright cylinder that holds the beads, its axis along z; m.")
      .def(py::init([](double diameter, double height, double axis_x, double axis_y, double bottom) {
             for (const double size : {diameter, height})
               if (!(size > 0.0) || !std::isfinite(size))
                 bad_input("specimen: found a size of {} m, expected one above 0", size);
             return Specimen{diameter, height, axis_x, axis_y, bottom};
           }),
           py::arg("diameter_m"), py::arg("height_m"), py::arg("axis_x_m") = 0.0, py::arg("axis_y_m") = 0.0,
           py::arg("bottom_m") = 0.0)
      .def_readonly("diameter_m", &Specimen::diameter)
      .def_readonly("height_m", &Specimen::height)
      .def_readonly("axis_x_m", &Specimen::axis_x)
      .def_readonly("axis_y_m", &Specimen::axis_y)
      .def_readonly("bottom_m", &Specimen::bottom)
      .def("__repr__", [](const Specimen& s) {
        return fmt::format("Specimen(diameter_m={}, height_m={}, axis_x_m={}, axis_y_m={}, bottom_m={})",
                           s.diameter, s.height, s.axis_x, s.axis_y, s.bottom);
      });
}

py::object array_of(const PolyTable::Array& array) {
  return std::visit(
      []<typename T>(const std::vector<T>& values) -> py::object {
        const auto n = static_cast<py::ssize_t>(values.size());
        if constexpr (std::is_same_v<T, Vec3>)
          return py::array_t<double>({n, py::ssize_t{3}}, reinterpret_cast<const double*>(values.data()));
        else
          return py::array_t<T>(n, values.data());
      },
      array);
}

py::dict polydata(const fs::path& path) {
  const PolyTable table = unlocked([&] { return read_polydata(path); });
  py::dict points, lines, result;
  for (const auto& [name, array] : table.point_data) points[py::str(name)] = array_of(array);
  for (const auto& [name, array] : table.line_data) lines[py::str(name)] = array_of(array);
  result["points_um"] = array_of(table.points);
  result["lines"] = py::array_t<int>({static_cast<py::ssize_t>(table.lines.size()), py::ssize_t{2}},
                                     reinterpret_cast<const int*>(table.lines.data()));
  result["point_data"] = points;
  result["line_data"] = lines;
  result["fields"] = py::cast(table.number_fields);
  for (const auto& [name, text] : table.text_fields) result["fields"][py::str(name)] = text;
  return result;
}

}  // namespace

void add_packings(py::module_& module) {
  add_specimen(module);
  py::class_<Packing>(
      module, "Packing",
      "Beads, bridges and the cylinder that holds them. `beads` and `bridges` are read-only structured "
      "arrays over its own memory, as read_beads() and read_bridges() give them; without a specimen the "
      "smallest upright cylinder around the beads is taken.")
      .def(py::init(&make_packing), py::arg("beads"), py::arg("bridges") = py::none(),
           py::arg("specimen") = std::nullopt)
      .def_property_readonly(
          "beads",
          [](const py::object& self) { return part(self, self.cast<const Packing&>().beads, bead_fields()); })
      .def_property_readonly("bridges",
                             [](const py::object& self) {
                               return part(self, self.cast<const Packing&>().bridges, bridge_fields());
                             })
      .def_readonly("specimen", &Packing::specimen)
      .def("input", [](const Packing& packing) { return input_of(packing); })
      .def_property_readonly("provenance",
                             [](const Packing& packing) { return to_python(to_json(packing.provenance)); });
  py::class_<PackedWithReport>(module, "Packed")
      .def_readonly("packing", &PackedWithReport::packing)
      .def_property_readonly("report",
                             [](const PackedWithReport& packed) { return to_python(packed.report); });
  module.def("pack", &pack);
  module.def("generate", &generate);
  module.def("read_packing", &read_packing, py::call_guard<py::gil_scoped_release>());
  module.def("write_packing", &write_packing, py::call_guard<py::gil_scoped_release>());
  module.def("read_exchange", [](const fs::path& path) {
    const py::gil_scoped_release released;
    return read_exchange(path, exchange_format_of(path));
  });
  module.def("read_beads", [](const fs::path& path) {
    return records(unlocked([&] { return read_beads(path); }), bead_fields());
  });
  module.def("read_bridges", [](const fs::path& path, const py::object& beads) {
    const auto of = beads_from(beads, "beads");
    return records(unlocked([&] { return read_bridges(path, of); }), bridge_fields());
  });
  module.def("write_beads", [](const fs::path& path, const py::object& array, const Origin& origin) {
    const auto beads = beads_from(array, "beads");
    const py::gil_scoped_release released;
    write_beads(path, beads, provenance_of(origin));
  });
  module.def("write_bridges", [](const fs::path& path, const py::object& array, const py::object& joined,
                                 const Origin& origin) {
    const auto beads = beads_from(array, "beads");
    const auto bridges = bridges_from(joined, beads, "bridges");
    const py::gil_scoped_release released;
    write_bridges(path, beads, bridges, provenance_of(origin));
  });
  module.def("read_polydata", &polydata);
}

}  // namespace pendular::python
