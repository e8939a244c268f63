#include "planted_run.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/random.h"
#include "packing/neighbours.h"
#include "packing/polydata.h"

namespace pendular::test {
namespace {

constexpr double kLastStrain = 0.08;

/// Hexagonal layers, jittered by a few per cent of a diameter.
std::vector<Vec3> lattice(const PlantedRun& p) {
  std::vector<Vec3> centres;
  const double d = 1.02 * p.bead_diameter, row = d * std::sqrt(0.75), layer = d * std::sqrt(2.0 / 3.0);
  const double room = 0.5 * (p.specimen_diameter - p.bead_diameter);
  const int reach = static_cast<int>(p.specimen_diameter / d) + 2;
  std::uint64_t draws = 0;
  for (int k = 0; (k + 0.5) * layer < p.specimen_height - 0.5 * p.bead_diameter; ++k)
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        Vec3 c(i * d + 0.5 * d * ((j + k) & 1), j * row + (k & 1) * row / 3.0, (k + 0.6) * layer);
        for (int axis = 0; axis < 3; ++axis) c[axis] += 0.04 * d * (random_uniform(1, draws++) - 0.5);
        if (c.head<2>().norm() < room) centres.push_back(c);
      }
  return centres;
}

/// How much of the slip lies below a point: 0 under the band, 1 above it, a smooth step inside.
double step(const PlantedRun& p, const Vec3& c) {
  const double s = (c - p.point()).dot(p.normal()) / p.band_thickness;
  return 0.5 * (1.0 + std::tanh(2.0 * s));
}

constexpr double kLimit = 0.034, kPeak = 0.044;  // strains beyond the toe

/// Platen stress over strain: toe, line, rounding to the peak, softening.
double stress(const PlantedRun& p, double strain) {
  const double linear = strain - p.toe, peak = 0.5 * (kLimit + kPeak);
  if (linear < p.toe) return p.modulus * p.toe * std::pow(strain / (2.0 * p.toe), 2);
  if (linear < kLimit) return p.modulus * linear;
  if (linear < kPeak) return p.modulus * (linear - std::pow(linear - kLimit, 2) / (2.0 * (kPeak - kLimit)));
  return p.modulus * peak * (0.55 + 0.45 * std::exp(-std::pow((linear - kPeak) / 0.012, 2)));
}

struct State {
  double load, strain;
  std::vector<Vec3> position, displacement;
};

State state_at(const PlantedRun& p, const std::vector<Vec3>& start, double load) {
  State s{load, load * kLastStrain, start, start};
  const Vec3 n = p.normal(), down_dip = (Vec3::UnitZ() - n.z() * n).normalized() * -1.0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double band = load * load;  // localises late
    s.displacement[i] =
        Vec3(0, 0, -0.02 * load * start[i].z()) + band * p.slip * step(p, start[i]) * down_dip;
    s.position[i] = start[i] + s.displacement[i];
  }
  return s;
}

PolyTable frame_table(const PlantedRun& p, const std::vector<Vec3>& start,
                      const std::vector<IndexPair>& bonds, const State& s) {
  PolyTable table;
  const std::size_t beads = start.size();
  std::vector<double> shear(beads), damage(beads), degree(beads), force;
  std::vector<std::int64_t> ids(beads), state, standing(beads);
  for (const auto& [i, j] : bonds) {
    const Vec3 middle = 0.5 * (start[static_cast<std::size_t>(i)] + start[static_cast<std::size_t>(j)]);
    const bool broken =
        s.load > 0.6 && std::abs((middle - p.point()).dot(p.normal())) < 0.35 * s.load * p.band_thickness;
    const Vec3 axis = (start[static_cast<std::size_t>(j)] - start[static_cast<std::size_t>(i)]).normalized();
    const double noise =
        random_uniform(3, static_cast<std::uint64_t>(i) * 100003u + static_cast<std::uint64_t>(j));
    table.lines.push_back({i, j});
    force.push_back(broken ? 0.0 : s.load * (2e-3 * axis.z() * axis.z() * noise * noise * 3.0 - 3e-4));
    state.push_back(broken ? 1 : 0);
    for (int bead : {i, j}) {
      degree[static_cast<std::size_t>(bead)] += 1.0;
      if (broken)
        damage[static_cast<std::size_t>(bead)] += 1.0;
      else
        ++standing[static_cast<std::size_t>(bead)];
    }
  }
  for (std::size_t i = 0; i < beads; ++i) {
    ids[i] = static_cast<std::int64_t>(i) + 1;
    const double inside = step(p, start[i]);
    shear[i] = 0.01 * s.load + s.load * s.load * p.slip / p.band_thickness * 4.0 * inside * (1.0 - inside) *
                                   (0.8 + 0.4 * random_uniform(2, i));
    if (degree[i] > 0.0) damage[i] /= degree[i];
    table.points.push_back(1e6 * s.position[i]);
  }
  std::vector<Vec3> displacement = s.displacement;
  for (Vec3& u : displacement) u *= 1e6;
  table.point_data = {{"bead_id", ids},
                      {"diameter_um", std::vector<double>(beads, 1e6 * p.bead_diameter)},
                      {"displacement_um", displacement},
                      {"local_shear_strain", shear},
                      {"local_volumetric_strain", std::vector<double>(beads, 0.0)},
                      {"coordination", standing},
                      {"damage", damage}};
  table.line_data = {{"normal_force_n", force}, {"state", state}};
  table.number_fields = {{"strain", s.strain},
                         {"stress_pa", stress(p, s.strain)},
                         {"platen_bottom_um", 0.0},
                         {"platen_top_um", 1e6 * (1.0 - s.strain) * p.specimen_height},
                         {"specimen_diameter_um", 1e6 * p.specimen_diameter}};
  return table;
}

std::string curve_text(const PlantedRun& p) {
  std::string text = "# planted\nstrain,stress_pa,stress_bottom_pa,broken_bonds,kinetic_energy_j\n";
  for (int k = 0; k <= 400; ++k) {
    const double strain = kLastStrain * k / 400.0;
    text += fmt::format("{:.9g},{:.9g},{:.9g},0,0\n", strain, stress(p, strain), stress(p, strain));
  }
  return text;
}

std::string events_text(const PlantedRun& p) {
  std::string text = "strain,bead_i,bead_j,x_um,y_um,z_um,mode,energy_j\n";
  for (std::uint64_t k = 0; k < 900; ++k) {
    const double strain = p.toe + 0.042 + 0.006 * random_normal(5, k);
    if (strain > 0.0 && strain < kLastStrain) text += fmt::format("{:.9g},1,2,0,0,0,tension,1e-9\n", strain);
  }
  return text;
}

std::string result_text(const PlantedRun& p, std::size_t beads, std::size_t bonds) {
  const Vec3 n = p.normal(), down_dip = -(Vec3::UnitZ() - n.z() * n).normalized();
  const Vec3 at = 1e6 * (p.point() + 0.5 * p.slip * down_dip - Vec3(0.0, 0.0, 0.02 * p.point().z()));
  nlohmann::ordered_json json;
  json["linear_modulus_pa"] = {{"value", p.modulus}, {"sigma", 0.01 * p.modulus}};
  json["fit"] = {{"strain_range", {0.008, 0.03}}, {"toe_strain", p.toe}};
  json["linear_limit_strain"] = kLimit;
  json["peak"] = {{"strain", kPeak}, {"stress_pa", stress(p, p.toe + kPeak)}};
  json["shear_band"] = {{"found", true},
                        {"normal", {n.x(), n.y(), n.z()}},
                        {"point_um", {at.x(), at.y(), at.z()}},
                        {"thickness_um", 1e6 * p.band_thickness},
                        {"contrast", 8.0}};
  json["beads"] = beads;
  json["bonds"] = bonds;
  json["provenance"] = {{"version", "test"}, {"command", "planted <run> & \"co\""}};
  return json.dump(2);
}

}  // namespace

Vec3 PlantedRun::normal() const {
  return Vec3(std::cos(band_angle) * std::cos(band_azimuth), std::cos(band_angle) * std::sin(band_azimuth),
              std::sin(band_angle));
}

void write_planted_run(const std::filesystem::path& folder, const PlantedRun& planted) {
  const auto start = lattice(planted);
  const std::vector<double> diameters(start.size(), planted.bead_diameter);
  const auto bonds = pairs_within(start, diameters, 0.1 * planted.bead_diameter);
  make_folder(folder / "frames");
  for (int k = 0; k < planted.frames; ++k) {
    const double load = planted.frames > 1 ? static_cast<double>(k) / (planted.frames - 1) : 1.0;
    write_polydata(folder / "frames" / fmt::format("frame_{:04d}.vtp", k),
                   frame_table(planted, start, bonds, state_at(planted, start, load)));
  }
  write_text(folder / "curve.csv", curve_text(planted));
  write_text(folder / "events.csv", events_text(planted));
  write_text(folder / "result.json", result_text(planted, start.size(), bonds.size()));
}

}  // namespace pendular::test
