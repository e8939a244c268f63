#include <fmt/format.h>

#include <algorithm>

#include "reproduction/sections.h"
#include "viz/render_run.h"
#include "viz/series_plot.h"

namespace pendular::reproduction {
namespace {

using viz::Series;

/// The local shear strain at the end of a point's first run, where it kept frames.
void add_picture(const Desk& desk, const Point& point, Section& section) {
  if (point.runs.front().frames.empty()) return;
  const double fraction = point.sample.specimen.volume_fraction;
  viz::RenderOptions options;
  options.view = "shear_strain";
  options.film = false;
  options.size = {800, 600};
  options.provenance = desk.provenance;
  const auto summary =
      viz::render_run(point.runs.front().path, desk.out / fmt::format("fraction_{:g}", fraction), options);
  const auto& end = summary.pictures.back();
  section.figures.push_back({fs::relative(end.file, desk.out).string(), "",
                             fmt::format("Volume fraction {:g}. {}", fraction, end.caption)});
}

/// How the stress falls after the peak in the densest packing and in the loosest.
void compare_ends(const std::vector<Point>& points, Section& section) {
  const auto looser = [](const Point& a, const Point& b) {
    return a.sample.specimen.volume_fraction < b.sample.specimen.volume_fraction;
  };
  const auto [loosest, densest] = std::minmax_element(points.begin(), points.end(), looser);
  const double dense = spread_of(*densest, stress_kept).mean, loose = spread_of(*loosest, stress_kept).mean,
               swelling = spread_of(*densest, volume_change_at_peak).mean,
               compaction = spread_of(*loosest, volume_change_at_peak).mean;
  section.comparisons = {
      {fmt::format("densest, {:g}", densest->sample.specimen.volume_fraction), "brittle, shear band",
       fmt::format("keeps {:.2f} of its peak", dense), within(dense, 0.0, 0.6)},
      {fmt::format("loosest, {:g}", loosest->sample.specimen.volume_fraction), "ductile",
       fmt::format("keeps {:.2f} of its peak", loose), within(loose, 0.8, 1.0)},
      {"volume at the peak, loosest and densest", "compaction where loose",
       fmt::format("{:+.1f} % and {:+.1f} %", 100.0 * compaction, 100.0 * swelling),
       compaction < 0.0 && compaction < swelling}};
}

}  // namespace

Section volume_fraction_section(const Desk& desk, const std::vector<Point>& points) {
  Section section{"Failure against the volume fraction (companion paper)",
                  "Only the initial volume fraction changes. The companion finds shear bands in dense "
                  "packings, then ductile "
                  "failure, then compaction as packings get looser. Stress kept: at the end of the run over "
                  "the highest. Volume: its change at mid-height, positive where the specimen swells."};
  section.table = Table{{"volume fraction", "Z", "E, MPa", "peak, MPa", "at strain, %", "stress kept",
                         "volume at the peak, %", "broken, % of bonds", "shear band, contrast"},
                        {}};
  std::vector<Series> curves;
  std::string csv = "volume_fraction,strain,stress_pa\n";
  for (const auto& point : points) {
    if (point.runs.empty()) continue;
    const double fraction = point.sample.specimen.volume_fraction;
    const auto broken = [](const RunFolder& run) {
      return static_cast<double>(run.break_strain.size()) / static_cast<double>(run.result.bonds.value_or(0));
    };
    const Spread band = spread_of(point, band_contrast);
    section.table->rows.push_back(
        {fmt::format("{:g}", fraction), in_words(spread_of(point, coordination_number), 1.0, 2),
         in_words(spread_of(point, modulus), 1e6), in_words(spread_of(point, peak_stress), 1e6, 2),
         in_words(spread_of(point, peak_strain), 0.01), in_words(spread_of(point, stress_kept), 1.0, 2),
         in_words(spread_of(point, volume_change_at_peak), 0.01), in_words(spread_of(point, broken), 0.01),
         band.count > 0 ? in_words(band) : "none found"});
    Series& curve = curves.emplace_back();
    curve.label = fmt::format("{:g}", fraction);
    curve.look = Series::Look::line;
    const auto& run = point.runs.front();
    for (std::size_t k = 0; k < run.strain.size(); ++k) {
      curve.x.push_back(100.0 * run.strain[k]);
      curve.y.push_back(1e-6 * run.stress[k]);
      csv += fmt::format("{:g},{:.9g},{:.9g}\n", fraction, run.strain[k], run.stress[k]);
    }
    add_picture(desk, point, section);
  }
  if (curves.empty()) return section;
  compare_ends(points, section);
  section.figures.insert(
      section.figures.begin(),
      desk.keep("volume_fraction", viz::series_figure(curves, {"strain (%)"}, {"stress (MPa)"}), csv,
                "Stress over strain at different volume fractions (first realisation)."));
  return section;
}

}  // namespace pendular::reproduction
