#include "blind/scans.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "blind/noise.h"
#include "dem_core/bond_bodies.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "packing/bridges.h"

namespace pendular::blind {
namespace {

constexpr double um = 1e-6;
constexpr double kLost = 0.01;         // share of the beads
constexpr double kShift = 40e-6;       // m, along each axis
constexpr double kTilt = M_PI / 90.0;  // of the specimen's axis, rad
constexpr double kDrift = 0.005;       // of the voxel size
constexpr double kUndetermined = 0.02, kMistaken = 0.005;
constexpr double kNeckError = 0.02;  // over the neck's diameter
constexpr double kSure = 0.99;       // probability that is stated of a bridge that is seen
constexpr std::uint64_t kSecondScan = 0x7363616e;

/// How a specimen lies in the scanner the second time.
class Placement {
 public:
  explicit Placement(Noise& noise) {
    using Eigen::AngleAxisd;
    rotation_ = (AngleAxisd(noise.between(-M_PI, M_PI), Vec3::UnitZ()) *
                 AngleAxisd(noise.between(-kTilt, kTilt), Vec3::UnitX()) *
                 AngleAxisd(noise.between(-kTilt, kTilt), Vec3::UnitY()))
                    .toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) shift_[axis] = noise.between(-kShift, kShift);
    scale_ = 1.0 + noise.between(-kDrift, kDrift);
  }
  Vec3 operator()(const Vec3& p) const { return scale_ * (rotation_ * p) + shift_; }
  double scale() const { return scale_; }

 private:
  Eigen::Matrix3d rotation_;
  Vec3 shift_;
  double scale_;
};

/// The specimen under load as a scan without noise reports it: with what is withheld of the measurement.
Packing loaded(const ScannedSpecimen& specimen) {
  Packing packing = specimen.test.packing;
  const double voxel = specimen.reported.specimen.diameter / packing.specimen.diameter;
  for (std::size_t k = 0; k < packing.beads.size(); ++k)
    packing.beads[k].centre = voxel * (packing.beads[k].centre + specimen.test.scan.displacement[k]);
  return effects::reading(packing, specimen.test.sample, random_bits(specimen.plan.seed, kSecondScan) >> 1);
}

/// What necks differ by, as the sample states it, beside what they do in the test: where one stiffness stands
/// for all bridges it has them alike, and yet a scan shows them as they are.
double spread_beside(const TrueTest& test) {
  double sum = 0.0, square = 0.0;
  for (const auto& body : test.bodies) sum += body.neck_diameter;
  const double count = std::max<double>(1.0, static_cast<double>(test.bodies.size())), mean = sum / count;
  for (const auto& body : test.bodies) square += std::pow(body.neck_diameter - mean, 2) / count;
  const double stated = 1e-6 * effects::spread_of_bridges(test.sample).diameter_sd;
  return std::sqrt(std::max(0.0, stated * stated - square));
}

}  // namespace

Table followed_beads(const ScannedSpecimen& specimen, double strain, nlohmann::ordered_json& told) {
  Noise noise(specimen.plan.seed, "second scan");
  const double sigma = specimen.split.sigma_centre, misjudged = noise.misjudged();
  const Placement placed(noise);
  const Packing packing = loaded(specimen);
  Table table{{"strain", "bead_id", "x_um", "y_um", "z_um", "ux_um", "uy_um", "uz_um", "sigma_um"}, {}};
  for (std::size_t k = 0; k < packing.beads.size(); ++k) {
    Vec3 now = placed(packing.beads[k].centre);
    for (int axis = 0; axis < 3; ++axis) now[axis] += sigma * noise.normal();
    if (noise.chance(kLost)) continue;
    const Bead& first = specimen.measured[k];
    const Vec3 at = first.centre / um, moved = (now - first.centre) / um;
    table.rows.push_back({strain, static_cast<double>(first.id), at.x(), at.y(), at.z(), moved.x(), moved.y(),
                          moved.z(), misjudged * M_SQRT2 * sigma / um});
  }
  told["displacements"] = {
      {"sigma_um", M_SQRT2 * sigma / um}, {"stated_over_true_sigma", misjudged}, {"scale", placed.scale()}};
  return table;
}

std::set<std::pair<int, int>> bridges_at_rest(const TrueTest& test) {
  std::set<std::pair<int, int>> standing;
  for (const auto& bridge : test.packing.bridges)
    if (bridge.state == BridgeState::candidate) standing.insert({bridge.i, bridge.j});
  return standing;
}

std::vector<Bridge> measured_bridges(const ScannedSpecimen& specimen, const std::string& name,
                                     const std::set<std::pair<int, int>>& standing,
                                     nlohmann::ordered_json& told) {
  Noise noise(specimen.plan.seed, name);
  const double misjudged = noise.misjudged();
  std::map<std::pair<int, int>, double> necks;
  const auto bonds = dem_core::standing_bridges(specimen.test.packing);
  for (std::size_t k = 0; k < bonds.size(); ++k)
    necks[{bonds[k].i, bonds[k].j}] = specimen.test.bodies[k].neck_diameter;
  const double cutoff = specimen.split.sample.bridges.cutoff * specimen.split.sample.beads.diameter;
  auto bridges = candidate_bridges(specimen.measured, cutoff);
  const double own = spread_beside(specimen.test);
  Noise neck_of_pair(specimen.plan.seed, "necks of a scan");  // the same in every scan
  for (auto& bridge : bridges) {
    const bool mistaken = noise.chance(kMistaken), undetermined = noise.chance(kUndetermined);
    const bool seen = standing.contains({bridge.i, bridge.j}) != mistaken;
    const double error = noise.normal(), apart = own * neck_of_pair.normal();
    bridge.state = undetermined ? BridgeState::undetermined : seen ? BridgeState::bridge : BridgeState::none;
    bridge.probability = undetermined ? 0.5 : seen ? kSure : 1.0 - kSure;
    if (bridge.state != BridgeState::bridge) continue;
    const auto neck = necks.find({bridge.i, bridge.j});
    const double mean = neck != necks.end() ? neck->second : specimen.test.sample.bridges.diameter;
    bridge.diameter = (mean + apart) * (1.0 + kNeckError * error);
    bridge.sigma_diameter = misjudged * kNeckError * bridge.diameter;
  }
  told[name] = {{"relative_sigma", kNeckError}, {"stated_over_true_sigma", misjudged}};
  return bridges;
}

}  // namespace pendular::blind
