// Specimens with something planted in a known place, for bench/place/run: place_cases SEED OUT.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <iostream>

#include "base/random.h"
#include "blind/mechanism.h"
#include "dem_core/joints.h"
#include "diagnosis/specimens.h"
#include "effects/compress.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "packing/polydata.h"
#include "packing/tables.h"
#include "packing/vtp.h"

using namespace pendular;
namespace {
constexpr double um = 1e-6, kStrain = 0.015, kSigma = 0.1 * um;
constexpr int kMembers = 24;

std::vector<Vec3> displacements(const Packing& packing, Sample sample, const fs::path& scratch,
                                const blind::Mechanism* mechanism = nullptr, double theta = 0) {
  CompressOptions options;
  if (mechanism && mechanism->simulation)
    options.prepare = [=](Simulation& s) { mechanism->simulation(s, theta); };
  fs::remove_all(scratch);
  effects::compress_with_effects(packing, sample, 1, scratch, options);
  const PolyTable frame = read_polydata(scratch / "frames" / "frame_0000.vtp");
  std::vector<Vec3> u;
  for (const Vec3& v : vectors(frame, true, "displacement_um", scratch)) u.push_back(um * v);
  fs::remove_all(scratch);
  return u;
}
void write(const fs::path& path, const std::vector<Vec3>& rest, const std::vector<Vec3>& u,
           const std::vector<int>& mask = {}) {
  std::ofstream out(path);
  for (std::size_t k = 0; k < u.size(); ++k)
    out << fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {}\n", rest[k].x() / um, rest[k].y() / um,
                       rest[k].z() / um, u[k].x() / um, u[k].y() / um, u[k].z() / um,
                       mask.empty() ? 0 : mask[k]);
}
std::vector<Vec3> centres(const std::vector<Bead>& beads) {
  std::vector<Vec3> all;
  for (auto& b : beads) all.push_back(b.centre);
  return all;
}
}  // namespace

int main(int, char** argv) {
  const auto seed = std::stoull(argv[1]);
  const fs::path out = argv[2];
  fs::create_directories(out);
  Sample sample = read_sample(fs::path(argv[3]));
  sample.specimen.diameter = 2100 * um, sample.specimen.height = 2200 * um;
  sample.beads.diameters = "measured";
  sample.observe = {false, false, false, false, false};
  sample.compression.frames = 0;
  sample.compression.max_strain = 1.005 * kStrain;
  sample.compression.frame_at = {kStrain};
  Packing truth = generate_packing(sample, seed);
  truth.bridges = candidate_bridges(truth.beads, sample.bridges.cutoff * sample.beads.diameter);
  std::vector<Bead> measured = truth.beads;
  std::size_t id = 0;
  for (auto& b : measured) {
    b.sigma_centre = kSigma, b.sigma_diameter = kSigma;
    for (int a = 0; a < 3; ++a) b.centre[a] += kSigma * random_normal(seed + 77, 4 * id + a);
    b.diameter += kSigma * random_normal(seed + 77, 4 * id + 3);
    ++id;
  }
  write_beads(out / "beads.csv", measured, {});
  diagnosis::Condition condition{sample, out / "beads.csv", {0}};
  for (int m = 1; m <= kMembers; ++m) {
    const auto source = diagnosis::beads_of_member(condition, m, sample, out / "packings");
    const Packing p = read_packing(source.file);
    write(out / fmt::format("member_{}.txt", m), centres(p.beads), displacements(p, sample, out / "scratch"));
    if (m == 1) {
      Simulation s = build_simulation(p, sample);
      list_pairs(s, 0.06 * s.beads.mean_diameter());
      std::ofstream net(out / "network.txt");
      for (auto& j : joints_of(s, 1.1 * kStrain * s.initial_height))
        net << fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}\n", j.place.i, j.place.j, j.place.n.x(), j.place.n.y(), j.place.n.z(),
                           j.place.arm_i, j.place.arm_j, j.gap, j.law.kn, j.law.kt, j.law.rest, j.law.touch);
      std::ofstream(out / "law.txt") << fmt::format("{} {} {} {} {}\n", s.law.k_glass, s.law.kt_glass, s.bottom.z, s.top.z, s.law.one_spring);
    }
  }
  struct Planted { std::string id; double theta; };
  std::vector<Planted> planted = {{"none", 0}, {"weak_layer", 0.3}, {"weak_layer", 0.5}, {"weak_layer", 0.7}, {"crack", 0.5}, {"crack", 0.75}, {"crack", 1.0},
      {"platen_overhang", 0.15}, {"platen_overhang", 0.28}, {"platen_overhang", 0.4}, {"sleeve", 0.3}, {"sleeve", 0.45}, {"sleeve", 0.6}};
  int number = 0;
  for (auto& [name, theta] : planted) {
    ++number;
    Packing p = truth;
    const blind::Mechanism* m = name == "none" ? nullptr : &blind::find_mechanism(name, "");
    if (m && m->packing) m->packing(p, theta);
    std::vector<int> mask(p.beads.size(), 0);
    if (m) {
      // What bonds change.
      Simulation plain = build_simulation(truth, sample), other = build_simulation(p, sample);
      if (m->simulation) m->simulation(other, theta);
      std::map<std::pair<int, int>, double> kn;
      for (auto& pair : plain.pairs) if (pair.bond >= 0) kn[{pair.i, pair.j}] += pair.properties.kn;
      for (auto& pair : other.pairs) if (pair.bond >= 0) kn[{pair.i, pair.j}] -= pair.properties.kn;
      for (auto& [ij, d] : kn) if (std::fabs(d) > 1e-9) mask[ij.first] = mask[ij.second] = 1;
      if (name == "platen_overhang") {
        double left = 1, right = -1;
        for (auto& q : plain.beads.position) left = std::min(left, q.x()), right = std::max(right, q.x());
        for (std::size_t k = 0; k < mask.size(); ++k)
          mask[k] = plain.beads.position[k].x() > right - theta * (right - left) && plain.beads.position[k].z() > plain.top.z - plain.beads.mean_diameter();
      }
    }
    auto u = displacements(p, sample, out / "scratch", m, theta);
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.01, Vec3::UnitX()) * Eigen::AngleAxisd(0.3, Vec3::UnitZ())).toRotationMatrix();
    for (std::size_t k = 0; k < u.size(); ++k) {
      Vec3 now = 1.003 * (turn * (truth.beads[k].centre + u[k])) + Vec3(30, -20, 10) * um;
      for (int a = 0; a < 3; ++a) now[a] += kSigma * random_normal(seed + 1000 + number, 3 * k + a);
      u[k] = now - measured[k].centre;
    }
    write(out / fmt::format("case_{}_{}.txt", name, theta), centres(measured), u, mask);
  }
}
