#include <nlohmann/json.hpp>

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "cli/command.h"
#include "cli/picture_commands.h"
#include "pipette/measure.h"
#include "pipette/overlay.h"
#include "pipette/report.h"
#include "viz/gnuplot.h"
#include "viz/pipette_plot.h"

namespace pendular::cli {
namespace {

struct PipetteOptions {
  Common common;
  fs::path frames, calibration, check, film;
};

/// Points of the frames from `first` to `last`, and the line through them.
viz::ForceBranch branch_of(const pipette::Measurement& m, std::size_t first, std::size_t last,
                           const std::optional<pipette::Branch>& fit, const char* name) {
  viz::ForceBranch branch;
  branch.label = name;
  for (std::size_t k = first; k <= last && k < m.frames.size(); ++k) {
    if (!m.curve.used[k]) continue;
    branch.displacement_um.push_back(1e6 * m.curve.extension[k]);
    branch.force_un.push_back(1e6 * m.curve.force[k]);
  }
  if (fit)
    branch.line = viz::ForceBranch::Line{
        fmt::format("{}: {:.4g} N/m, linear range {:.3g} to {:.3g} \u00b5m", name, fit->line.slope,
                    1e6 * fit->first_extension, 1e6 * fit->last_extension),
        fit->line.slope, 1e6 * fit->line.intercept, 1e6 * fit->first_extension, 1e6 * fit->last_extension};
  return branch;
}

void write_plot(const fs::path& out, const pipette::Measurement& m, const Provenance& provenance) {
  const auto figure =
      viz::force_figure(branch_of(m, 0, m.fit.turn, m.fit.loading, "loading"),
                        branch_of(m, m.fit.turn + 1, m.frames.size(), m.fit.unloading, "unloading"));
  viz::write_figure(figure, {beside(out, ".png"), beside(out, ".pdf")}, to_comment(provenance));
}

/// The stage's speed is known without the images: a difference points at the scale or the frame rate.
void check_speed(const pipette::Measurement& m) {
  const auto& c = m.calibration;
  const double tolerance = 0.05 + 3.0 * c.metres_per_pixel_sigma / c.metres_per_pixel;
  if (std::abs(m.stage_speed / c.stage_speed - 1.0) > tolerance)
    warn(fmt::format(
        "the wafer moves at {:.3g} um/s in the images, the calibration says {:.3g} (camera.um_per_pixel, "
        "camera.frame_rate_hz or stage.speed_um_s is wrong)",
        1e6 * m.stage_speed, 1e6 * c.stage_speed));
}

void report(const pipette::Measurement& m) {
  const auto rejected = std::count(m.curve.used.begin(), m.curve.used.end(), 0);
  say(fmt::format("{} frames, {} rejected, {} missing", m.frames.size(), rejected, m.missing.size()));
  if (!m.fit.stiffness) return;
  const auto& k = *m.fit.stiffness;
  say(fmt::format(
      "{} = {:.4g} N/m, 90 % interval {:.4g} to {:.4g}; sigma of the fit {:.2g}, of the calibration {:.2g}",
      m.calibration.direction == pipette::Direction::normal ? "kn" : "kt", k.value, k.low, k.high,
      k.fit_sigma, k.calibration_sigma));
}

void run(const PipetteOptions& options) {
  const fs::path& out = options.common.out;
  if (out.extension() != ".csv")
    throw BadUsage(fmt::format("pipette: --out: found {}, expected a name ending in .csv", out.string()));
  if (!options.film.empty() && options.film.extension() != ".mp4" && options.film.extension() != ".avi")
    throw BadUsage(fmt::format("pipette: --film: found {}, expected a name ending in .mp4 or .avi",
                               options.film.string()));
  const std::vector<fs::path> outputs = {out, beside(out, ".json"), beside(out, ".png"), beside(out, ".pdf"),
                                         options.film};
  apply(options.common, {options.calibration}, outputs);
  protect_also(pipette::FrameSource(options.frames).files());
  require_outputs(outputs);
  const pipette::Calibration calibration = pipette::read_calibration(options.calibration);
  const pipette::Measurement m = pipette::measure(options.frames, calibration);
  if (!options.check.empty()) make_folder(options.check);
  const Provenance origin =
      provenance(options.common, {pipette::FrameSource(options.frames).origin(), options.calibration});

  WrittenTogether written;
  write_text(beside(out, ".json"), pipette::to_json(m, origin).dump(2) + "\n");
  write_text(out, pipette::to_csv(m, origin));
  write_plot(out, m, origin);
  if (!options.check.empty()) pipette::write_check_pictures(options.check, options.frames, m);
  if (!options.film.empty()) pipette::write_film(options.film, options.frames, m);
  written.commit();
  check_speed(m);
  report(m);
  if (!m.fit.stiffness)
    bad_input("{}: found no linear range while loading, so there is no stiffness (the curve is in {})",
              options.frames.string(), out.string());
}

}  // namespace

void add_pipette(CLI::App& app) {
  auto options = std::make_shared<PipetteOptions>();
  auto* command = add_picture_command(app, "pipette");
  command
      ->add_option("frames", options->frames,
                   "Video, folder of numbered images, or their names with a * (8 or 16 bits; colour is "
                   "turned to grey)")
      ->required();
  command->add_option("--calibration", options->calibration, "Calibration file (.toml)")->required();
  command->add_option("--check", options->check, "Folder for pictures of outlines and tracks on frames");
  command->add_option("--film", options->film, "Film of the tracks on the frames (.mp4 or .avi)");
  add_common(*command, options->common, "Curve to write (.csv)");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
