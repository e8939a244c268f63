#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/files.h"
#include "base/vec3.h"

namespace pendular {

/// The plane along which a specimen shears.
struct ShearPlane {
  Vec3 normal = Vec3::UnitZ();  ///< unit length, z component not negative
  Vec3 point = Vec3::Zero();    ///< m
  double thickness = 0.0;       ///< m
  double contrast = 0.0;        ///< mean local shear strain inside over outside

  /// Between the plane and the compression axis, rad, 0 to π/2.
  double angle_to_axis() const;
};

/// What a run says of itself (result.json); what it does not say is empty.
struct RunResult {
  std::optional<double> modulus, modulus_sigma;    ///< Pa
  double toe = 0.0;                                ///< platen strain where the fitted line meets zero stress
  std::optional<double> linear_limit;              ///< strain beyond the toe
  std::optional<double> peak_strain, peak_stress;  ///< beyond the toe; Pa
  std::optional<ShearPlane> band;
  std::optional<std::int64_t> beads, bonds, broken_bonds;
  std::optional<double> coordination;     ///< bridges per interior bead before loading
  std::optional<double> height, section;  ///< of the specimen before its test, m, m²
  std::optional<double> final_strain;
  std::optional<double> inertial_number, unbalanced_force;  ///< largest where the curve is linear
  std::optional<double> work_balance_error;                 ///< relative
  nlohmann::ordered_json provenance;                        ///< null where absent
};

/// BadInput where the file is missing, no JSON object, or holds something else than a number where one is
/// expected, or one that no run can have.
RunResult read_result(const fs::path& file);

}  // namespace pendular
