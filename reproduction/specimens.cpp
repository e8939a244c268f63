#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/number_cell.h"
#include "dem_core/compress.h"
#include "dem_core/simulation.h"
#include "micromechanics/stiffness.h"
#include "packing/statistics.h"
#include "packing/vtp.h"
#include "reproduction/paper.h"
#include "reproduction/sections.h"
#include "viz/plot.h"
#include "viz/render_run.h"
#include "viz/series_plot.h"

namespace pendular::reproduction {
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// All curves under each other, and the breaks of each in the paper's bins.
std::string curves_csv(const Point& point) {
  std::string csv = "realisation,strain,strain_beyond_toe,stress_pa,breaks_in_bin\n";
  for (std::size_t r = 0; r < point.runs.size(); ++r) {
    const auto& run = point.runs[r];
    for (std::size_t k = 0; k < run.strain.size(); ++k) {
      const double bin = std::floor(run.strain[k] / viz::kBreakBin) * viz::kBreakBin;
      const auto first = std::lower_bound(run.break_strain.begin(), run.break_strain.end(), bin);
      const auto last = std::lower_bound(first, run.break_strain.end(), bin + viz::kBreakBin);
      csv += fmt::format("{},{:.9g},{:.9g},{:.9g},{}\n", r + 1, run.strain[k], run.strain[k] - run.result.toe,
                         run.stress[k], last - first);
    }
  }
  return csv;
}

/// The plane of the first run's shear band in a picture of local shear strain, where frames were kept.
void add_band_picture(const Desk& desk, const std::string& name, const Point& point, Section& section) {
  if (point.runs.front().frames.empty()) return;
  viz::RenderOptions options;
  options.view = "shear_strain";
  options.film = false;
  options.size = {800, 600};
  options.provenance = desk.provenance;
  const fs::path folder = desk.out / name;
  const auto summary = viz::render_run(point.runs.front().path, folder, options);
  const auto& end = summary.pictures.back();
  section.figures.push_back({fs::relative(end.file, desk.out).string(), "", end.caption});
}

std::vector<Comparison> comparisons_of(const Point& point) {
  const double polymer = point.sample.bridges.youngs_modulus;
  const Spread e = spread_of(point, modulus), limit = spread_of(point, linear_limit),
               z = spread_of(point, coordination_number),
               broken = spread_of(point, broken_share_before_limit), band = spread_of(point, band_contrast);
  return {
      {"realisations", "at least 5", std::to_string(point.runs.size()), point.runs.size() >= 5,
       "Fewer were asked for (--realisations)."},
      {"Z, bridges per interior bead", "7.4 ± 0.1", in_words(z, 1.0, 2),
       within(z.mean, kPaperCoordination - 0.1, kPaperCoordination + 0.1)},
      {"E", "about ten times E_p measured, twice that simulated",
       fmt::format("{} MPa, {:.1f} E_p", in_words(e, 1e6), e.mean / polymer),
       within(e.mean / polymer, 10.0, 20.0),
       "Most of the modulus is made by neighbours whose glass touches, which are ten times stiffer than "
       "bonds. How "
       "many touch depends on the positions, and on how the drawn diameters are kept from overlapping, which "
       "one "
       "sentence of the paper leaves open (docs/model.md, \"Drawing diameters\"). What E and its limit hang "
       "on: below."},
      {"spread of E among realisations", "little variation",
       e.count > 1 ? fmt::format("{:.1f} %", 100.0 * e.sd / e.mean) : "–", within(e.sd / e.mean, 0.0, 0.05)},
      {"linear limit, strain beyond the toe", "about 4 %", in_words(limit, 0.01, 2) + " %",
       within(limit.mean, kPaperLinearLimit - 0.01, kPaperLinearLimit + 0.01),
       "Breaking ends the linear part, and the criterion lets bonds of softer polymer stretch further: the "
       "stretch is "
       "√(2 G l/E_p)."},
      {"bonds broken before the linear limit", "few", in_words(broken, 0.01, 2) + " % of all",
       within(broken.mean, 0.0, 0.02)},
      {"shear band", "across the sample",
       fmt::format("in {} of {} runs, local shear {} times that outside", band.count, point.runs.size(),
                   in_words(band)),
       band.count == point.runs.size()},
  };
}

}  // namespace

Section specimen_section(const Desk& desk, const std::string& name, const Point& point) {
  Section section{
      fmt::format("Sample {} (Fig. 3)", name),
      fmt::format("{:.2f} × {:.2f} mm at volume fraction {:g}, kn = {:.0f} N/m. The stress is drawn over "
                  "the platen's strain since first touch, the linear limit counts from where the line "
                  "meets zero stress.",
                  1e3 * point.sample.specimen.diameter, 1e3 * point.sample.specimen.height,
                  point.sample.specimen.volume_fraction,
                  micromechanics::bond_stiffness(point.sample).normal)};
  if (point.runs.empty()) return section;
  section.comparisons = comparisons_of(point);
  if (name == "A") {
    const double speed = dem_core::platen_speed(point.sample);
    section.comparisons.push_back({"platen speed at 1e-4 in model units", "46.4 mm/s",
                                   fmt::format("{:.2f} mm/s", 1e3 * speed),
                                   within(speed / kPaperPlatenSpeed, 0.99, 1.01)});
  }
  const std::string file = "curves_" + lower_case(name);
  section.figures.push_back(
      desk.keep(file, viz::stress_strain_figure(point.runs, {1200, 900}), curves_csv(point),
                fmt::format("Sample {}: stress over strain, and broken bonds per bin of 4.2e-4.", name)));
  add_band_picture(desk, "band_" + lower_case(name), point, section);
  return section;
}

Section coordination_section(const Desk& desk, sweep::Store& store, std::span<const Point> specimens) {
  Section section{
      "Bridges per bead against the cut-off",
      "Interior beads of the packings above with drawn diameters (first realisation). The paper chose a "
      "cut-off of 0.064 D because it gives Z = 7.4."};
  std::vector<viz::Series> series;
  std::string csv = "specimen,cutoff_over_d,z\n";
  for (std::size_t s = 0; s < specimens.size(); ++s) {
    if (specimens[s].requests.empty()) continue;
    const auto& request = specimens[s].requests.front();
    const Packing packing = dem_core::realise(read_packing(store.packing_path(sweep::packing_hash(request))),
                                              request.sample, request.seed);
    const double mean = request.sample.beads.diameter;
    const auto statistics = packing_statistics(packing, request.sample.bridges.cutoff * mean);
    auto& curve = series.emplace_back();
    curve.label = fmt::format("{:.2f} mm high", 1e3 * request.sample.specimen.height);
    curve.look = viz::Series::Look::line;
    for (const auto& [cutoff, z] : statistics.coordination_curve) {
      curve.x.push_back(cutoff / mean);
      curve.y.push_back(z);
      csv += fmt::format("{},{:.6g},{:.6g}\n", s + 1, NumberCell{cutoff / mean}, NumberCell{z});
    }
  }
  if (series.empty()) return section;
  viz::Series stated;
  stated.label = "the paper's";
  stated.x = {kPaperCutoff};
  stated.y = {kPaperCoordination};
  stated.sd = {0.1};
  series.push_back(stated);
  section.figures.push_back(desk.keep("coordination",
                                      viz::series_figure(series, {"cut-off / D"}, {"bridges per bead"}), csv,
                                      "Z against the cut-off."));
  return section;
}

}  // namespace pendular::reproduction
