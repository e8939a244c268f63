#include "viz/render_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "viz/film.h"
#include "viz/frame.h"
#include "viz/gnuplot.h"
#include "viz/plot.h"
#include "viz/scene.h"
#include "viz/viewer/run_view.h"

namespace pendular::viz {
namespace {

constexpr const char* kFilmView = "shear_strain";

/// A frame to draw and the word for it in file names and captions.
struct Moment {
  std::string word, caption;
  Frame frame;
};

/// The frame at the highest stress and the last one; one of them where they are the same.
std::vector<Moment> moments(const RunFolder& run) {
  std::size_t peak = 0;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    stop_if_interrupted();
    const double stress = read_frame(run.frames[k]).stress;
    if (stress > highest) highest = stress, peak = k;
  }
  std::vector<Moment> found;
  if (peak + 1 < run.frames.size()) found.push_back({"peak", "At the peak", read_frame(run.frames[peak])});
  found.push_back({"end", "At the end", read_frame(run.frames.back())});
  return found;
}

std::vector<RunFolder> read_runs(const fs::path& path) {
  std::vector<RunFolder> runs;
  for (const fs::path& folder : realisations(path)) runs.push_back(read_run_folder(folder));
  return runs;
}

std::string with_sigma(double value, const std::optional<double>& sigma, double unit) {
  return sigma ? fmt::format("{:.3g} \u00b1 {:.1g}", value / unit, *sigma / unit)
               : fmt::format("{:.3g}", value / unit);
}

double degrees(double angle) {
  return angle * 180.0 / std::numbers::pi;
}

}  // namespace

RenderSummary render_run(const fs::path& path, const fs::path& out, const RenderOptions& options) {
  std::vector<View> chosen = views();
  if (!options.view.empty()) chosen = {view_named(options.view)};
  std::vector<RunFolder> runs = read_runs(path);
  const RunFolder& run = runs.front();
  const Frame first = read_frame(run.frames.front());
  const auto drawn = moments(run);
  const Stage stage = make_stage(first, drawn.back().frame, run.result);
  make_folder(out);

  const std::string comment = to_json(options.provenance).dump();
  const Display display;
  RenderSummary summary;
  summary.realisations = runs.size();
  summary.coordination = interior_coordination(first);
  Progress progress("pictures", static_cast<double>(1 + drawn.size() * chosen.size()));
  const auto keep = [&](const std::string& name, const std::string& caption) {
    summary.pictures.push_back({out / name, caption});
    progress.update(static_cast<double>(summary.pictures.size()), name);
    stop_if_interrupted();
  };
  write_figure(stress_strain_figure(runs, options.size),
               {out / "stress_strain.png", out / "stress_strain.pdf", out / "stress_strain.svg"}, comment);
  keep("stress_strain.svg",
       "Stress over platen strain with the linear fit, the end of the linear range and the peak; bars: "
       "broken bonds.");
  {  // its window is closed before the film opens one
    ScenePainter painter(display, options.size);
    for (const View& view : chosen)
      for (const Moment& moment : drawn) {
        const std::string name = view.name + "_" + moment.word + ".png";
        write_png(out / name,
                  painter.draw(view, moment.frame, stage, colour_range(view, moment.frame, stage)), comment);
        keep(name, fmt::format("{} ({:.2f} % strain). {}", moment.caption, 100.0 * moment.frame.strain,
                               view.caption));
      }
  }
  if (options.film) {
    const View& view = view_named(options.view.empty() ? kFilmView : options.view);
    const ColourRange range = colour_range(view, drawn.back().frame, stage);
    summary.video =
        make_film(display, view, run.frames, stage, range, out / "film", options.film_size, comment).video;
  }
  summary.run = std::move(runs.front());
  return summary;
}

ReportSection compression_section(const RenderSummary& summary) {
  const RunResult& result = summary.run.result;
  ReportSection section;
  section.heading = "Compression";
  const auto add = [&](const std::string& quantity, const std::string& value, const std::string& unit) {
    section.rows.push_back({quantity, value, unit});
  };
  if (result.beads) add("Beads", std::to_string(*result.beads), "");
  if (result.bonds) add("Bonds before loading", std::to_string(*result.bonds), "");
  if (std::isfinite(summary.coordination))
    add("Coordination number, interior beads", fmt::format("{:.2f}", summary.coordination), "");
  if (result.modulus) add("Linear modulus E", with_sigma(*result.modulus, result.modulus_sigma, 1e6), "MPa");
  if (result.linear_limit)
    add("Linear limit, strain beyond the toe", fmt::format("{:.2f}", 100.0 * *result.linear_limit), "%");
  if (result.peak_strain)
    add("Peak, strain beyond the toe", fmt::format("{:.2f}", 100.0 * *result.peak_strain), "%");
  if (result.peak_stress) add("Peak stress", fmt::format("{:.3g}", 1e-6 * *result.peak_stress), "MPa");
  add("Broken bonds", std::to_string(summary.run.break_strain.size()), "");
  if (result.band) {
    add("Shear band, angle to the compression axis",
        fmt::format("{:.0f}", degrees(result.band->angle_to_axis())), "\u00b0");
    add("Shear band, thickness", fmt::format("{:.0f}", 1e6 * result.band->thickness), "\u00b5m");
    add("Shear band, local shear strain inside over outside", fmt::format("{:.1f}", result.band->contrast),
        "");
  }
  section.pictures = summary.pictures;
  section.specimens = {run_view(summary.run)};
  return section;
}

std::string compression_summary(const RenderSummary& summary) {
  const RunResult& result = summary.run.result;
  std::string text;
  const auto add = [&](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  if (result.beads && result.bonds)
    add(fmt::format("The packing holds {} beads and {} bonds.", *result.beads, *result.bonds));
  if (std::isfinite(summary.coordination))
    add(fmt::format("An interior bead has {:.2f} bonds on average.", summary.coordination));
  if (result.modulus)
    add(fmt::format("Under uniaxial compression the linear modulus is {} MPa.",
                    with_sigma(*result.modulus, result.modulus_sigma, 1e6)));
  if (result.linear_limit)
    add(fmt::format("The response stays linear up to {:.2f} % strain beyond the toe.",
                    100.0 * *result.linear_limit));
  if (result.peak_stress && result.peak_strain)
    add(fmt::format("Stress peaks at {:.3g} MPa and {:.2f} % strain.", 1e-6 * *result.peak_stress,
                    100.0 * *result.peak_strain));
  add(fmt::format("{} bonds broke in all.", summary.run.break_strain.size()));
  add(result.band
          ? fmt::format("The specimen failed along a shear band at {:.0f}\u00b0 to the compression axis.",
                        degrees(result.band->angle_to_axis()))
          : "No shear band was found.");
  return text;
}

}  // namespace pendular::viz
