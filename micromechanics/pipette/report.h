#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/provenance.h"
#include "pipette/measure.h"

namespace pendular::pipette {

/// time_s,displacement_um,force_n,score,used; one row per frame. Empty cells where a frame was not tracked;
/// provenance as comments.
std::string to_csv(const Measurement& measurement, const Provenance& provenance);

/// stiffness_n_per_m, interval_90, fit_sigma, calibration_sigma (N/m), linear_range_um — null where there is
/// no linear range —, both branches, diameters, rejected and missing frames, provenance.
nlohmann::ordered_json to_json(const Measurement& measurement, const Provenance& provenance);

}  // namespace pendular::pipette
