// What is planted in a known place of a specimen, and whether the map finds it: bench/place/run.
//
//   place_bench SAMPLE.toml FIRST_SEED COUNT [none]
//
// A row per specimen and mechanism; `none`: specimens with nothing planted only. The bank of a specimen: its
// measured beads moved by their errors, and one run each.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/progress.h"
#include "base/random.h"
#include "blind/mechanism.h"
#include "diagnosis/experiment/specimens.h"
#include "diagnosis/repair/place.h"
#include "effects/compress.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "packing/polydata.h"
#include "packing/tables.h"
#include "packing/vtp.h"

using namespace pendular;

namespace {

constexpr double um = 1e-6, kStrain = 0.015;
constexpr double kSigma = 0.1 * um;  // of centres, per scan, and of diameters
constexpr int kMembers = 24;

struct Planted {
  std::string mechanism;
  double theta;
};
const std::vector<Planted> kPlanted = {{"none", 0.0},
                                       {"weak_layer", 0.3},
                                       {"weak_layer", 0.5},
                                       {"weak_layer", 0.7},
                                       {"crack", 0.5},
                                       {"crack", 0.75},
                                       {"crack", 1.0},
                                       {"platen_overhang", 0.15},
                                       {"platen_overhang", 0.28},
                                       {"platen_overhang", 0.4},
                                       {"sleeve", 0.3},
                                       {"sleeve", 0.45},
                                       {"sleeve", 0.6}};

Sample sample_of(const std::string& path) {
  Sample sample = read_sample(fs::path(path));
  sample.specimen.diameter = 2100 * um, sample.specimen.height = 2200 * um;
  sample.beads.diameters = Diameters::measured;
  sample.observe = {false, false, false, false, false};
  sample.compression.frames = 0.0;
  sample.compression.max_strain = 1.005 * kStrain;
  sample.compression.frame_at = {kStrain};
  return sample;
}

std::vector<Vec3> displacements(const Packing& packing, const Sample& sample, const fs::path& scratch,
                                const dem_core::CompressOptions& options = {}) {
  fs::remove_all(scratch);
  dem_core::compress(packing, sample, scratch, options);
  std::vector<Vec3> u;
  for (const Vec3& v :
       vectors(read_polydata(scratch / "frames" / "frame_0000.vtp"), true, "displacement_um", scratch))
    u.push_back(um * v);
  return u;
}

std::vector<Bead> measured_beads(std::vector<Bead> beads, std::uint64_t seed) {
  for (std::size_t k = 0; k < beads.size(); ++k) {
    beads[k].sigma_centre = beads[k].sigma_diameter = kSigma;
    for (int axis = 0; axis < 3; ++axis)
      beads[k].centre[axis] += kSigma * random_normal(seed, 4 * k + static_cast<unsigned>(axis));
    beads[k].diameter += kSigma * random_normal(seed, 4 * k + 3);
  }
  return beads;
}

/// What the second scan shows: turned, shifted, its scale drifted, with errors of its own.
std::vector<Vec3> followed(const Packing& truth, const std::vector<Bead>& measured, std::vector<Vec3> u,
                           std::uint64_t seed) {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.01, Vec3::UnitX()) * Eigen::AngleAxisd(0.3, Vec3::UnitZ())).toRotationMatrix();
  for (std::size_t k = 0; k < u.size(); ++k) {
    Vec3 now = 1.003 * (turn * (truth.beads[k].centre + u[k])) + Vec3(30, -20, 10) * um;
    for (int axis = 0; axis < 3; ++axis)
      now[axis] += kSigma * random_normal(seed, 3 * k + static_cast<unsigned>(axis));
    u[k] = now - measured[k].centre;
  }
  return u;
}

/// The beads whose bonds a mechanism changes; of an overhang, those within a diameter of where the platen is
/// missing.
std::vector<bool> beads_of_place(const Planted& planted, const dem_core::Simulation& plain,
                                 const dem_core::Simulation& changed) {
  std::vector<bool> of_place(plain.beads.size(), false);
  std::map<std::pair<int, int>, double> kn;
  for (const auto& pair : plain.pairs)
    if (pair.bond >= 0) kn[{pair.i, pair.j}] += pair.properties.kn;
  for (const auto& pair : changed.pairs)
    if (pair.bond >= 0) kn[{pair.i, pair.j}] -= pair.properties.kn;
  for (const auto& [pair, change] : kn)
    if (std::fabs(change) > 1e-9)
      of_place[static_cast<std::size_t>(pair.first)] = of_place[static_cast<std::size_t>(pair.second)] = true;
  if (planted.mechanism == "platen_overhang")
    for (std::size_t k = 0; k < of_place.size(); ++k)
      of_place[k] = changed.top.relief[k] > 0.5 &&
                    plain.beads.position[k].z() > plain.top.z - plain.beads.mean_diameter();
  return of_place;
}

/// Area under the receiver's curve: the probability that a bead of the place has the larger value.
double area(const std::vector<double>& values, const std::vector<bool>& of_place) {
  double larger = 0.0, pairs = 0.0;
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t b = 0; b < values.size(); ++b)
      if (of_place[a] && !of_place[b]) pairs += 1.0, larger += values[a] > values[b];
  return pairs > 0.0 ? larger / pairs : std::nan("");
}

void report(std::uint64_t seed, const Planted& planted, const diagnosis::Place& place,
            const std::vector<bool>& of_place) {
  std::vector<double> z, inside;
  std::size_t found = 0, beads = 0;
  double largest = 0.0;
  for (std::size_t k = 0; k < of_place.size(); ++k) {
    z.push_back(std::fabs(place.stiffness.change[k]) / place.stiffness.sigma[k]);
    if (of_place[k]) inside.push_back(100.0 * std::expm1(place.stiffness.change[k]));
    beads += of_place[k], found += of_place[k] && place.stands_out(k);
    largest = std::max(largest, place.misfit.value[k]);
  }
  std::sort(inside.begin(), inside.end());
  fmt::print("{},{},{},{},{},{:.3f},{:.3f},{},{},{:.2f},{:.2f},{:.1f},{:.1f},{:.0f},{:.1f},\"{}\"\n", seed,
             planted.mechanism, planted.theta, of_place.size(), beads, area(place.misfit.value, of_place),
             area(z, of_place), found, place.count(), largest, place.misfit.threshold,
             *std::max_element(z.begin(), z.end()), place.stiffness.threshold,
             inside.empty() ? 0.0 : inside[inside.size() / 2], place.stiffness.left, place.words);
  std::fflush(stdout);
}

void run(std::uint64_t seed, const Sample& sample, bool none_only, const fs::path& scratch) {
  Packing truth = generate_packing(sample, seed);
  truth.bridges = candidate_bridges(truth.beads, sample.bridges.cutoff * sample.beads.diameter);
  const auto measured = measured_beads(truth.beads, seed + 77);
  make_folder(scratch);
  write_beads(scratch / "beads.csv", measured, {});
  const diagnosis::Condition condition{sample, scratch / "beads.csv", {0}};
  diagnosis::ScannedMotion scan{kStrain, {}, {}, {}, M_SQRT2 * kSigma, {}};
  for (const auto& bead : measured) scan.ids.push_back(bead.id), scan.rest.push_back(bead.centre);
  Packing believed;
  diagnosis::MemberPackings packings(scratch / "packings");
  for (int member = 1; member <= kMembers; ++member) {
    const auto source = packings.of(condition, member, sample);
    const Packing packing = read_packing(source.file);
    if (member == 1) believed = packing;
    scan.simulated.push_back(displacements(packing, sample, scratch / "run"));
  }
  const dem_core::Simulation specimen = dem_core::build_simulation(believed, sample),
                             plain = dem_core::build_simulation(truth, sample);
  std::uint64_t number = seed + 1000;
  for (const auto& planted : kPlanted) {
    ++number;
    if (none_only && planted.mechanism != "none") continue;
    Packing packing = truth;
    dem_core::CompressOptions options;
    if (planted.mechanism != "none") {
      const auto& mechanism = blind::find_mechanism(planted.mechanism, "place_bench");
      if (mechanism.packing) mechanism.packing(packing, planted.theta);
      if (mechanism.simulation)
        options.prepare = [&](dem_core::Simulation& s) { mechanism.simulation(s, planted.theta); };
    }
    dem_core::Simulation changed = dem_core::build_simulation(packing, sample);
    if (options.prepare) options.prepare(changed);
    scan.measured =
        followed(truth, measured, displacements(packing, sample, scratch / "run", options), number);
    report(seed, planted, diagnosis::place_of(scan, specimen, scan.ids),
           beads_of_place(planted, plain, changed));
  }
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) return 2;
  set_quiet(true);
  const Sample sample = sample_of(words[1]);
  fmt::print(
      "seed,mechanism,theta,beads,of_place,auc_misfit,auc_stiffness,found,stand_out,largest_misfit,threshold,"
      "largest_z,z_threshold,median_change_percent,left_over_noise,words\n");
  const auto first = std::stoull(words[2]);
  for (std::uint64_t seed = first; seed < first + std::stoull(words[3]); ++seed) {
    const fs::path scratch = fs::temp_directory_path() / fmt::format("place_bench_{}", seed);
    run(seed, sample, count > 4, scratch);
    fs::remove_all(scratch);
  }
}
