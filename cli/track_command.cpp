#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <Eigen/Geometry>
#include <memory>

#include "base/error.h"
#include "base/progress.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "cli/picture_commands.h"
#include "packing/bridges.h"
#include "packing/statistics.h"
#include "packing/tables.h"
#include "tracking/motion.h"
#include "viz/scene.h"

namespace pendular::cli {
namespace {

constexpr std::size_t kLeastBeads = 10;

struct TrackOptions {
  Common common;
  fs::path before, after, pictures;
  tracking::TrackOptions track;
};

nlohmann::ordered_json in_um(const Vec3& v) {
  return {1e6 * v.x(), 1e6 * v.y(), 1e6 * v.z()};
}

nlohmann::ordered_json to_json(const tracking::Registration& registration) {
  const Eigen::Matrix3d& r = registration.motion.rotation;
  const Eigen::AngleAxisd turn(r);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({r(row, 0), r(row, 1), r(row, 2)});
  return {{"meaning", "after = scale * rotation * before + shift"},
          {"rotation", rows},
          {"angle_deg", turn.angle() * 180.0 / M_PI},
          {"axis", {turn.axis().x(), turn.axis().y(), turn.axis().z()}},
          {"shift_um", in_um(registration.motion.shift)},
          {"scale", registration.motion.scale},
          {"scale_sigma", registration.scale_sigma},
          {"scale_from", to_string(registration.scale_from)},
          {"beads", registration.beads},
          {"rms_residual_um", 1e6 * registration.rms_residual},
          {"rms_residual_even_um", 1e6 * registration.rms_residual_even},
          {"axial_stretch", registration.axial_stretch}};
}

nlohmann::ordered_json band_of(const tracking::Motion& motion) {
  if (!motion.band.found) return nullptr;
  const Vec3& normal = motion.band.normal;
  return {{"normal", {normal.x(), normal.y(), normal.z()}},
          {"point_um", in_um(motion.band.point)},
          {"thickness_um", 1e6 * motion.band.thickness},
          {"contrast", motion.band.contrast},
          {"angle_to_axis_deg", motion.band.angle_to_axis * 180.0 / M_PI}};
}

/// How many beads, and which.
nlohmann::ordered_json listed(const std::vector<Bead>& beads, const std::vector<int>& places) {
  nlohmann::ordered_json ids = nlohmann::ordered_json::array();
  for (const int place : places) ids.push_back(beads[static_cast<std::size_t>(place)].id);
  return {{"count", places.size()}, {"ids", ids}};
}

nlohmann::ordered_json summary(const std::vector<Bead>& before, const std::vector<Bead>& after,
                               const tracking::Motion& motion, const Provenance& provenance) {
  std::vector<int> loose;
  for (std::size_t k = 0; k < motion.matches.size(); ++k)
    if (motion.loose[k]) loose.push_back(motion.matches[k].before);
  return {{"beads_before", before.size()},
          {"beads_after", after.size()},
          {"matched", motion.matches.size()},
          {"strain", motion.strain},
          {"nothing_moved", motion.still},
          {"registration", to_json(motion.registration)},
          {"loose", listed(before, loose)},
          {"lost", listed(before, motion.lost)},
          {"new", listed(after, motion.fresh)},
          {"shear_band", band_of(motion)},
          {"provenance", pendular::to_json(provenance)}};
}

viz::Frame frame_of(const std::vector<Bead>& before, const tracking::Motion& motion,
                    const Specimen& specimen) {
  viz::Frame frame;
  frame.strain = motion.strain;
  frame.stress = std::nan("");
  frame.platen_bottom = specimen.bottom;
  frame.platen_top = specimen.bottom + specimen.height;
  frame.specimen_diameter = specimen.diameter;
  for (std::size_t k = 0; k < motion.matches.size(); ++k) {
    frame.position.push_back(motion.start[k] + motion.displacement[k]);
    frame.displacement.push_back(motion.displacement[k]);
    frame.diameter.push_back(before[static_cast<std::size_t>(motion.matches[k].before)].diameter);
    frame.shear_strain.push_back(motion.local[k].shear);
  }
  frame.coordination.assign(frame.position.size(), 1.0);
  frame.damage.assign(frame.position.size(), 0.0);
  return frame;
}

void draw(const TrackOptions& options, const std::vector<Bead>& before, const std::vector<Bead>& after,
          const tracking::Motion& motion, const Provenance& origin) {
  make_folder(options.pictures);
  const viz::Frame frame = frame_of(before, motion, specimen_enclosing(after));
  viz::Frame first = frame_of(before, motion, specimen_enclosing(before));
  first.position = motion.start;
  first.displacement.assign(first.position.size(), Vec3::Zero());
  RunResult result;
  if (motion.band.found)
    result.band =
        ShearPlane{motion.band.normal, motion.band.point, motion.band.thickness, motion.band.contrast};
  const viz::Stage stage = viz::make_stage(first, frame, result);
  const viz::Display display;
  viz::ScenePainter painter(display);
  for (const char* name : {"displacement_cut", "shear_strain"}) {
    const viz::View& view = viz::view_named(name);
    viz::write_png(options.pictures / (std::string(name) + ".png"),
                   painter.draw(view, frame, stage, viz::colour_range(view, frame, stage)),
                   pendular::to_json(origin).dump());
  }
}

std::vector<Bead> read_scan(const fs::path& path) {
  auto beads = read_beads(path);
  if (beads.size() < kLeastBeads)
    bad_input("{}: found {} beads, expected at least {}", path.string(), beads.size(), kLeastBeads);
  return beads;
}

void report(const TrackOptions& options, const std::vector<Bead>& before, const std::vector<Bead>& after,
            const tracking::Motion& motion) {
  const tracking::Registration& registration = motion.registration;
  say(fmt::format(
      "{} of {} beads found again among {}, turned by {:.2f} degrees, scale {:.5f} +- {:.5f} (by {}), at "
      "a strain of {:.2f} %{}",
      motion.matches.size(), before.size(), after.size(),
      Eigen::AngleAxisd(registration.motion.rotation).angle() * 180.0 / M_PI, registration.motion.scale,
      registration.scale_sigma, to_string(registration.scale_from), 100.0 * motion.strain,
      motion.band.found ? fmt::format(", a shear band at {:.0f} degrees to the axis",
                                      motion.band.angle_to_axis * 180.0 / M_PI)
                        : ""));
  if (motion.still)
    warn(fmt::format(
        "{}: nothing moved since {}: displacements of {:.3g} um rms, no more than errors (the same scan?)",
        options.after.string(), options.before.string(), 1e6 * registration.rms_residual));
}

void run(const TrackOptions& options) {
  const fs::path& out = options.common.out;
  apply(options.common, {options.before, options.after}, {out, beside(out, ".json")});
  const auto before = read_scan(options.before), after = read_scan(options.after);
  const Provenance origin = provenance(options.common, {options.before, options.after});
  const tracking::Motion motion = [&] {
    try {
      return tracking::follow_beads(before, after, options.track);
    } catch (const BadInput& error) {
      throw BadInput(fmt::format("{}: {}", options.after.string(), error.what()));
    }
  }();
  WrittenTogether written;
  tracking::write_motion(out, before, after, motion, origin);
  if (!options.pictures.empty())
    draw(options, before, tracking::registered(after, motion.registration.motion), motion, origin);
  write_text(beside(out, ".json"), summary(before, after, motion, origin).dump(2) + "\n");
  written.commit();
  report(options, before, after, motion);
}

}  // namespace

void add_track(CLI::App& app) {
  auto options = std::make_shared<TrackOptions>();
  auto* command = add_picture_command(app, "track");
  command->add_option("before", options->before, "Beads of the first scan (beads.csv), ten or more")
      ->required();
  command->add_option("after", options->after, "Beads of the second scan (beads.csv), ten or more")
      ->required();
  command
      ->add_option("--strain", options->track.strain,
                   "Engineering strain between the scans; without it, that of the beads at either end")
      ->check(within(-0.5, 0.9));
  command
      ->add_option(
          "--reach", options->track.match.reach,
          "How far beads may be from where the even part of the motion brings them, in mean diameters")
      ->capture_default_str()
      ->check(within(0.1, 20.0));
  command->add_option("--pictures", options->pictures,
                      "Draw displacement and local strain, cut through the axis, into this folder");
  add_common(*command, options->common, "Displacements (track.csv)");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
