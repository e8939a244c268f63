#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "base/progress.h"
#include "cli/command.h"
#include "packing/bridges.h"
#include "packing/statistics.h"
#include "packing/tables.h"
#include "tracking/motion.h"
#include "viz/scene.h"

namespace pendular::cli {
namespace {

struct Options {
  Common common;
  fs::path before, after, pictures;
  std::optional<double> strain;
  MatchOptions match;
};

nlohmann::ordered_json summary(const std::vector<Bead>& before, const std::vector<Bead>& after,
                               const Motion& motion, const Provenance& provenance) {
  nlohmann::ordered_json band = nullptr;
  if (motion.band.found)
    band = {
        {"normal", {motion.band.normal.x(), motion.band.normal.y(), motion.band.normal.z()}},
        {"point_um", {1e6 * motion.band.point.x(), 1e6 * motion.band.point.y(), 1e6 * motion.band.point.z()}},
        {"thickness_um", 1e6 * motion.band.thickness},
        {"contrast", motion.band.contrast},
        {"angle_to_axis_deg", motion.band.angle_to_axis * 180.0 / M_PI}};
  return {
      {"beads_before", before.size()}, {"beads_after", after.size()}, {"matched", motion.matches.size()},
      {"strain", motion.strain},       {"shear_band", band},          {"provenance", to_json(provenance)}};
}

viz::Frame frame_of(const std::vector<Bead>& before, const Motion& motion, const Specimen& specimen) {
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

void draw(const Options& options, const std::vector<Bead>& before, const std::vector<Bead>& after,
          const Motion& motion, const Provenance& origin) {
  make_folder(options.pictures);
  const viz::Frame frame = frame_of(before, motion, specimen_enclosing(after));
  viz::Frame first = frame_of(before, motion, specimen_enclosing(before));
  first.position = motion.start;
  first.displacement.assign(first.position.size(), Vec3::Zero());
  viz::RunResult result;
  if (motion.band.found)
    result.band =
        viz::ShearBand{motion.band.normal, motion.band.point, motion.band.thickness, motion.band.contrast};
  const viz::Stage stage = viz::make_stage(first, frame, result);
  const viz::Display display;
  for (const char* name : {"displacement_cut", "shear_strain"}) {
    const viz::View& view = viz::view_named(name);
    viz::write_png(options.pictures / (std::string(name) + ".png"),
                   viz::draw_scene(display, view, frame, stage, viz::colour_range(view, frame, stage)),
                   to_json(origin).dump());
  }
}

void run(const Options& options) {
  apply(options.common);
  require_writable(options.common.out);
  const auto before = read_beads(options.before), after = read_beads(options.after);
  const Provenance origin = provenance(options.common, {options.before, options.after});
  const Motion motion = [&] {
    try {
      return motion_of(before, after, match_beads(before, after, options.match),
                       options.strain.value_or(shortening(before, after)));
    } catch (const BadInput& error) {
      throw BadInput(fmt::format("{}: {}", options.after.string(), error.what()));
    }
  }();
  write_motion(options.common.out, before, after, motion, origin);
  if (!options.pictures.empty()) draw(options, before, after, motion, origin);
  write_text(fs::path(options.common.out).replace_extension(".json"),
             summary(before, after, motion, origin).dump(2) + "\n");
  say(fmt::format("{} of {} beads found again among {}, at a strain of {:.2f} %{}", motion.matches.size(),
                  before.size(), after.size(), 100.0 * motion.strain,
                  motion.band.found ? fmt::format(", a shear band at {:.0f} degrees to the axis",
                                                  motion.band.angle_to_axis * 180.0 / M_PI)
                                    : ""));
}

}  // namespace

void add_track(CLI::App& app) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "track",
      "Beads of one specimen followed from a scan to the next: displacement and local strain.\n"
      "The table serves `pendular diagnose` as an observation of kind displacements. Scans may be shifted\n"
      "against each other by less than --reach, not turned. A summary goes beside the table as .json.");
  command->add_option("before", options->before, "Beads of the first scan (beads.csv)")->required();
  command->add_option("after", options->after, "Beads of the second scan (beads.csv)")->required();
  command
      ->add_option("--strain", options->strain,
                   "Engineering strain between the scans; without it, from the beads' extent along z")
      ->check(CLI::Range(-0.5, 0.9));
  command
      ->add_option("--reach", options->match.reach,
                   "How far beads may be from where an even compression brings them, in mean diameters")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 20.0));
  command->add_option("--pictures", options->pictures,
                      "Draw displacement and local strain, cut through the axis, into this folder");
  add_common(*command, options->common, "Displacements (track.csv)");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
