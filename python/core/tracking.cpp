#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "binding/arrays.h"
#include "binding/inputs.h"
#include "binding/json.h"
#include "binding/work.h"
#include "core/core.h"
#include "tracking/motion.h"

namespace pendular::python {
namespace {

constexpr std::size_t kLeastBeads = 10;

/// A bead in both scans.
struct Followed {
  std::int64_t before, after;
  Vec3 start, displacement;
  double sigma, score, shear, volumetric;
  bool loose;
};

py::dtype followed_fields() {
  static_assert(std::is_standard_layout_v<Followed>);
  py::list names, formats, offsets;
  const auto add = [&](const char* name, const char* format, std::size_t offset) {
    names.append(name), formats.append(format), offsets.append(offset);
  };
  constexpr std::size_t d = sizeof(double);
  add("bead_id", "i8", offsetof(Followed, before));
  add("bead_id_after", "i8", offsetof(Followed, after));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constexpr const char* places[] = {"x_m", "y_m", "z_m"};
    constexpr const char* ways[] = {"ux_m", "uy_m", "uz_m"};
    add(places[axis], "f8", offsetof(Followed, start) + axis * d);
    add(ways[axis], "f8", offsetof(Followed, displacement) + axis * d);
  }
  add("sigma_m", "f8", offsetof(Followed, sigma));
  add("score", "f8", offsetof(Followed, score));
  add("shear_strain", "f8", offsetof(Followed, shear));
  add("volumetric_strain", "f8", offsetof(Followed, volumetric));
  add("loose", "?", offsetof(Followed, loose));
  return {names, formats, offsets, static_cast<py::ssize_t>(sizeof(Followed))};
}

/// Two scans and what lies between them.
struct Track {
  std::vector<Bead> before, after;
  tracking::Motion motion;
  Provenance provenance;
};

std::vector<Bead> scan_from(const py::object& array, const char* argument) {
  auto beads = beads_from(array, argument);
  if (beads.size() < kLeastBeads)
    bad_input("{}: found {} beads, expected at least {}", argument, beads.size(), kLeastBeads);
  return beads;
}

Track track(const py::object& before, const py::object& after, const std::optional<double>& strain,
            double reach, const Origin& origin, const Terms& terms) {
  Track result{scan_from(before, "before"), scan_from(after, "after"), {}, provenance_of(origin)};
  tracking::TrackOptions options;
  options.strain = strain;
  options.match.reach = reach;
  return work(terms, [&] {
    result.motion = tracking::follow_beads(result.before, result.after, options);
    return std::move(result);
  });
}

std::vector<Followed> followed(const Track& track) {
  std::vector<Followed> rows;
  const tracking::Motion& m = track.motion;
  for (std::size_t k = 0; k < m.matches.size(); ++k)
    rows.push_back({track.before[static_cast<std::size_t>(m.matches[k].before)].id,
                    track.after[static_cast<std::size_t>(m.matches[k].after)].id, m.start[k],
                    m.displacement[k], m.sigma[k], m.matches[k].score, m.local[k].shear,
                    m.local[k].volumetric, m.loose[k]});
  return rows;
}

std::vector<std::int64_t> ids(const std::vector<Bead>& beads, const std::vector<int>& places) {
  std::vector<std::int64_t> found;
  for (const int place : places) found.push_back(beads[static_cast<std::size_t>(place)].id);
  return found;
}

py::dict registration_of(const Track& track) {
  const tracking::Registration& r = track.motion.registration;
  py::dict found;
  found["rotation"] = py::cast(Eigen::Matrix3d(r.motion.rotation));
  found["scale"] = r.motion.scale;
  found["scale_sigma"] = r.scale_sigma;
  found["scale_from"] = to_string(r.scale_from);
  found["shift_m"] = py::cast(Eigen::Vector3d(r.motion.shift));
  found["axial_stretch"] = r.axial_stretch;
  found["rms_residual_m"] = r.rms_residual;
  return found;
}

py::object band_of(const Track& track) {
  const kinematics::ShearBand& band = track.motion.band;
  if (!band.found) return py::none();
  py::dict found;
  found["normal"] = py::cast(Eigen::Vector3d(band.normal));
  found["point_m"] = py::cast(Eigen::Vector3d(band.point));
  found["thickness_m"] = band.thickness;
  found["contrast"] = band.contrast;
  found["angle_to_axis_rad"] = band.angle_to_axis;
  return found;
}

}  // namespace

void add_tracking(py::module_& module) {
  py::class_<Track>(
      module, "Track",
      "Beads followed between two scans, in the frame of the first: `beads` is a structured array of those "
      "found again, `lost` and `new` are ids of the others.")
      .def_property_readonly("beads",
                             [](const Track& track) { return records(followed(track), followed_fields()); })
      .def_property_readonly("lost", [](const Track& track) { return ids(track.before, track.motion.lost); })
      .def_property_readonly("new", [](const Track& track) { return ids(track.after, track.motion.fresh); })
      .def_property_readonly("strain", [](const Track& track) { return track.motion.strain; })
      .def_property_readonly("nothing_moved", [](const Track& track) { return track.motion.still; })
      .def_property_readonly("registration", &registration_of)
      .def_property_readonly("shear_band", &band_of)
      .def("write", [](const Track& track, const fs::path& path) {
        tracking::write_motion(path, track.before, track.after, track.motion, track.provenance);
      });
  module.def("track", &track);
}

}  // namespace pendular::python
