#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "binding/arrays.h"
#include "binding/work.h"
#include "pictures/pictures.h"
#include "segmentation/qa/qa.h"
#include "segmentation/segment.h"

namespace pendular::python {
namespace {

segmentation::BeadTone tone_of(const std::string& word) {
  if (word == "auto") return segmentation::BeadTone::automatic;
  if (word == "bright") return segmentation::BeadTone::bright;
  if (word == "dark") return segmentation::BeadTone::dark;
  throw BadUsage(fmt::format("beads: found \"{}\", expected \"auto\", \"bright\" or \"dark\"", word));
}

void require_between(const char* argument, double value, double lowest, double highest) {
  if (!(value >= lowest && value <= highest))
    throw BadUsage(
        fmt::format("{}: found {}, expected a number from {} to {}", argument, value, lowest, highest));
}

segmentation::Segmentation find_beads(const Volume& volume, double cutoff, const std::string& tone,
                                      const std::optional<double>& min_diameter_um, bool bridges,
                                      double false_discoveries, bool calibrate_bridges, const Terms& terms) {
  segmentation::SegmentOptions options;
  require_between("cutoff", cutoff, 0.0, 1.0);
  require_between("false_discoveries", false_discoveries, 0.0, 0.5);
  options.cutoff = cutoff;
  options.tone = tone_of(tone);
  if (min_diameter_um) options.least_diameter = 1e-6 * *min_diameter_um;
  if (bridges) options.bridges = {false_discoveries, calibrate_bridges};
  return work(terms, [&] {
    segmentation::Segmentation found = segmentation::segment(volume, options);
    for (const auto& warning : found.warnings) warn(warning);
    return found;
  });
}

template <typename T>
py::array part(const py::object& self, const std::vector<T>& values, const py::dtype& fields) {
  return view_of(values.data(), fields, {static_cast<py::ssize_t>(values.size())}, self);
}

py::object bridges_told(const segmentation::Segmentation& found) {
  if (!found.measured) return py::none();
  const segmentation::BridgeSummary& bridges = *found.measured;
  py::dict told;
  told["pairs"] = bridges.pairs, told["bridges"] = bridges.bridges, told["none"] = bridges.none;
  told["undetermined"] = bridges.undetermined, told["hidden"] = bridges.unseen;
  told["polymer_seen"] = bridges.polymer_seen, told["polymer_contrast"] = bridges.contrast;
  told["sigma_polymer_contrast"] = bridges.sigma_contrast, told["share_of_pairs"] = bridges.share;
  told["diameter_m"] = bridges.diameter, told["diameter_sd_m"] = bridges.diameter_sd;
  return told;
}

}  // namespace

void add_segmentation(py::module_& module) {
  py::class_<segmentation::Segmentation>(
      module, "Segmentation",
      "A tomogram taken apart: `beads`, `bridges` and irregular `grains` as structured arrays, SI; the "
      "container's inside as `specimen`, where one is seen.")
      .def_property_readonly("beads",
                             [](const py::object& self) {
                               return part(self, self.cast<const segmentation::Segmentation&>().beads,
                                           bead_fields());
                             })
      .def_property_readonly("bridges",
                             [](const py::object& self) {
                               return part(self, self.cast<const segmentation::Segmentation&>().bridges,
                                           bridge_fields());
                             })
      .def_property_readonly("grains",
                             [](const py::object& self) {
                               return part(self, self.cast<const segmentation::Segmentation&>().grains,
                                           bead_fields());
                             })
      .def_readonly("specimen", &segmentation::Segmentation::specimen)
      .def_property_readonly("measured_bridges", &bridges_told)
      .def_property_readonly("threshold",
                             [](const segmentation::Segmentation& found) { return found.levels.threshold; })
      .def_readonly("bright_beads", &segmentation::Segmentation::bright_beads)
      .def_readonly("porosity", &segmentation::Segmentation::porosity)
      .def_readonly("blur_m", &segmentation::Segmentation::blur)
      .def_readonly("noise_over_edge", &segmentation::Segmentation::noise)
      .def_readonly("rejected", &segmentation::Segmentation::rejected)
      .def("labels",
           [](const segmentation::Segmentation& found, const Volume& volume) {
             const py::gil_scoped_release released;
             return segmentation::label_volume(volume, found);
           })
      .def("write_qa",
           [](const segmentation::Segmentation& found, const fs::path& folder, const Volume& volume) {
             const py::gil_scoped_release released;
             segmentation::write_qa(folder, volume, found);
           });
  module.def("segment", &find_beads);
}

}  // namespace pendular::python
