#include "pipette/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "base/number_cell.h"

namespace pendular::pipette {
namespace {

using Json = nlohmann::ordered_json;

Json branch_json(const std::optional<Branch>& branch) {
  if (!branch) return nullptr;
  return {{"stiffness_n_per_m", branch->line.slope},
          {"fit_sigma", branch->line.slope_sigma},
          {"linear_range_um", {1e6 * branch->first_extension, 1e6 * branch->last_extension}},
          {"points", branch->line.points},
          {"frames", branch->frames},
          {"reduced_chi2", branch->line.reduced_chi2}};
}

/// A length in the image, with the sigmas of its measurement and of the scale apart.
Json length_json(double pixels, double sigma, const Calibration& c) {
  return {{"diameter_um", 1e6 * pixels * c.metres_per_pixel},
          {"measurement_sigma_um", 1e6 * sigma * c.metres_per_pixel},
          {"scale_sigma_um", 1e6 * pixels * c.metres_per_pixel_sigma}};
}

void add_stiffness(Json& json, const CurveFit& fit) {
  if (!fit.stiffness || !fit.loading) {
    for (const char* key :
         {"stiffness_n_per_m", "interval_90", "fit_sigma", "calibration_sigma", "linear_range_um"})
      json[key] = nullptr;
    json["reason"] = "no linear range was found while loading";
    return;
  }
  const Stiffness& k = *fit.stiffness;
  json["stiffness_n_per_m"] = k.value;
  json["interval_90"] = {k.low, k.high};
  json["fit_sigma"] = k.fit_sigma;
  json["calibration_sigma"] = k.calibration_sigma;
  json["linear_range_um"] = {1e6 * fit.loading->first_extension, 1e6 * fit.loading->last_extension};
}

}  // namespace

std::string to_csv(const Measurement& m, const Provenance& provenance) {
  std::string text = to_comment(provenance) + "time_s,displacement_um,force_n,score,used\n";
  for (std::size_t k = 0; k < m.frames.size(); ++k) {
    const FrameRecord& frame = m.frames[k];
    if (m.curve.used[k])
      text += fmt::format("{},{:.5f},{:.7e},{:.5f},1\n", NumberCell{frame.time},
                          NumberCell{1e6 * m.curve.extension[k]}, NumberCell{m.curve.force[k]},
                          NumberCell{frame.score});
    else
      text += fmt::format("{},,,{:.5f},0\n", NumberCell{frame.time}, NumberCell{frame.score});
  }
  return text;
}

Json to_json(const Measurement& m, const Provenance& provenance) {
  const Calibration& c = m.calibration;
  Json json;
  json["direction"] = c.direction == Direction::normal ? "normal" : "tangential";
  add_stiffness(json, m.fit);
  json["loading"] = branch_json(m.fit.loading);
  json["unloading"] = branch_json(m.fit.unloading);
  json["noise"] = {{"displacement_um", 1e6 * std::sqrt(m.fit.errors(0, 0))},
                   {"force_n", std::sqrt(m.fit.errors(1, 1))},
                   {"correlation", m.fit.errors(0, 1) / std::sqrt(m.fit.errors(0, 0) * m.fit.errors(1, 1))}};
  json["bead_fixed"] = length_json(2.0 * m.scene.fixed.radius, 2.0 * m.scene.fixed.radius_sigma, c);
  json["bead_free"] = length_json(2.0 * m.scene.free.radius, 2.0 * m.scene.free.radius_sigma, c);
  json["neck"] = m.scene.neck ? length_json(m.scene.neck->diameter, m.scene.neck->sigma, c) : Json(nullptr);
  json["stage_speed_um_s"] = {{"stated", 1e6 * c.stage_speed}, {"measured", 1e6 * m.stage_speed}};
  json["frames"] = m.frames.size();
  json["rejected"] = Json::array();
  for (const FrameRecord& frame : m.frames)
    if (!frame.rejected.empty())
      json["rejected"].push_back({{"frame", frame.number}, {"reason", frame.rejected}});
  json["missing"] = m.missing;
  json["provenance"] = to_json(provenance);
  return json;
}

}  // namespace pendular::pipette
