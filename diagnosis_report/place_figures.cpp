#include "diagnosis_report/place_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "viz/bead_map.h"
#include "viz/display.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Place;

constexpr double kUm = 1e6, kPercent = 100.0;
constexpr double kLargestMisfit = 5.0, kLargestChange = 100.0;  // at the ends of the colours

double change_percent(const Place& place, std::size_t bead) {
  return kPercent * std::expm1(place.stiffness.change[bead]);
}
double sigma_percent(const Place& place, std::size_t bead) {
  return kPercent * std::exp(place.stiffness.change[bead]) * place.stiffness.sigma[bead];
}

Table bead_table(const Place& place, const std::string& name) {
  Table table{name,
              {"bead_id", "x_um", "y_um", "z_um", "dx_um", "dy_um", "dz_um", "misfit", "stands_out",
               "stiffness_change_percent", "stiffness_change_sigma_percent"},
              {}};
  for (std::size_t k = 0; k < place.ids.size(); ++k) {
    const Vec3 at = kUm * place.rest[k], moved = kUm * place.misfit.difference[k];
    table.rows.push_back({static_cast<double>(place.ids[k]), at.x(), at.y(), at.z(), moved.x(), moved.y(),
                          moved.z(), place.misfit.value[k], place.stands_out(k) ? 1.0 : 0.0,
                          change_percent(place, k), sigma_percent(place, k)});
  }
  return table;
}

viz::BeadMap map_of(const Place& place) {
  viz::BeadMap map;
  map.centres = place.rest, map.diameters = place.diameter;
  map.values.resize(place.ids.size());
  map.note = fmt::format("{} of {} beads stand out", place.count(), place.ids.size());
  return map;
}

viz::BeadMap misfit_map(const Place& place) {
  viz::BeadMap map = map_of(place);
  map.title = "Where experiment and the simulation as believed part";
  map.quantity = "misfit over noise";
  map.values = place.misfit.value;
  map.low = 1.0;
  map.high = std::max(kLargestMisfit, 2.0 * place.misfit.threshold);
  return map;
}

Drawn misfit_figure(viz::Image image, const Place& place) {
  const std::string name = "place_misfit_" + place.observation;
  return {std::move(image),
          fmt::format(
              "{} Beads of {} at {:.2f} % strain behind a cut through the axis: how neighbours part "
              "otherwise than simulated, over the noise; one specimen in twenty exceeds {:.2f} anywhere by "
              "noise alone.",
              place.words, place.observation, kPercent * place.strain, place.misfit.threshold),
          bead_table(place, name)};
}

viz::BeadMap stiffness_map(const Place& place) {
  viz::BeadMap map = map_of(place);
  map.title = "What change of stiffness would mend it";
  map.quantity = "change of stiffness (%)";
  map.low = -kLargestChange, map.high = kLargestChange, map.is_signed = true;
  for (std::size_t k = 0; k < map.values.size(); ++k)
    map.values[k] = std::clamp(change_percent(place, k), map.low, map.high);
  return map;
}

Drawn stiffness_figure(viz::Image image, const Place& place) {
  const std::string name = "place_stiffness_" + place.observation;
  return {std::move(image),
          fmt::format(
              "Change of stiffness in {} regions of {} that brings the simulated displacements nearest to "
              "the measured ones, by the adjoint of the spring network; what it leaves is {:.1f} times the "
              "noise.",
              place.stiffness.regions, place.observation, place.stiffness.left),
          bead_table(place, name)};
}

}  // namespace

std::vector<Drawn> place_figures(const std::vector<Place>& places) {
  std::vector<Drawn> figures;
  if (places.empty()) return figures;
  std::vector<viz::BeadMap> maps;
  for (const Place& place : places) maps.push_back(misfit_map(place)), maps.push_back(stiffness_map(place));
  auto images = viz::draw_bead_maps(viz::Display(), maps, {1200, 900});
  for (std::size_t k = 0; k < places.size(); ++k) {
    figures.push_back(misfit_figure(std::move(images[2 * k]), places[k]));
    figures.push_back(stiffness_figure(std::move(images[2 * k + 1]), places[k]));
  }
  return figures;
}

viz::SpecimenView place_view(const Place& place) {
  using Colours = viz::SpecimenView::Colours;
  viz::SpecimenView view;
  view.caption = fmt::format("{} at {:.2f} % strain: where experiment and simulation part.",
                             place.observation, kPercent * place.strain);
  view.ids = place.ids;
  view.diameters = place.diameter;
  view.fields = {{"misfit over noise", "", Colours::alarm},
                 {"stands out (1: yes)", "", Colours::alarm},
                 {"measured less simulated displacement", "\u00b5m"},
                 {"change of stiffness that would mend it", "%", Colours::signed_values},
                 {"its standard deviation", "%"}};
  auto& moment = view.moments.emplace_back();
  moment.label = fmt::format("{:.2f} % strain", kPercent * place.strain);
  moment.centres = place.rest;
  moment.values.resize(view.fields.size());
  for (std::size_t k = 0; k < place.ids.size(); ++k) {
    moment.values[0].push_back(place.misfit.value[k]);
    moment.values[1].push_back(place.stands_out(k) ? 1.0 : 0.0);
    moment.values[2].push_back(kUm * place.misfit.difference[k].norm());
    moment.values[3].push_back(change_percent(place, k));
    moment.values[4].push_back(sigma_percent(place, k));
  }
  set_ranges(view);
  view.fields[0].low = 1.0;
  view.fields[0].high = std::max(kLargestMisfit, 2.0 * place.misfit.threshold);
  return view;
}

PolyTable place_polydata(const Place& place) {
  PolyTable table;
  std::vector<double> diameter, change, sigma;
  std::vector<Vec3> difference;
  std::vector<std::int64_t> stands_out;
  for (std::size_t k = 0; k < place.ids.size(); ++k) {
    table.points.push_back(kUm * place.rest[k]);
    diameter.push_back(kUm * place.diameter[k]);
    difference.push_back(kUm * place.misfit.difference[k]);
    stands_out.push_back(place.stands_out(k) ? 1 : 0);
    change.push_back(change_percent(place, k));
    sigma.push_back(sigma_percent(place, k));
  }
  table.point_data = {{"bead_id", place.ids},
                      {"diameter_um", diameter},
                      {"difference_um", difference},
                      {"misfit", place.misfit.value},
                      {"stands_out", stands_out},
                      {"stiffness_change_percent", change},
                      {"stiffness_change_sigma_percent", sigma}};
  table.number_fields = {{"strain", place.strain},
                         {"misfit_threshold", place.misfit.threshold},
                         {"misfit_cut", place.cut},
                         {"stiffness_threshold_sigmas", place.stiffness.threshold}};
  table.text_fields = {{"words", place.words}};
  return table;
}

}  // namespace pendular::diagnosis_report
