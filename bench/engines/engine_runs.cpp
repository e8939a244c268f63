// One specimen of a split, tested by one engine, with nothing or one effect withheld and no noise:
//   engine_runs SPLIT.toml PACKING ENGINE MEMBER OUT [EFFECT THETA]
// PACKING counts from 1. ENGINE is a name of blind/engine.cpp, or "own" for the simulation that diagnoses.
// MEMBER 0 has the beads as they are, others have them moved by the split's errors of measurement (for
// engines of the project's own program). Writes OUT.csv, the curve, OUT.field.csv, the displacements of the
// scan, and OUT.json, sizes.

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "blind/engine.h"
#include "blind/truth.h"
#include "effects/list.h"

namespace {

using namespace pendular;
using namespace pendular::blind;

void write_curve(const fs::path& path, const TrueTest& test) {
  std::string text = "strain,stress_pa,broken_bonds,lateral_strain\n";
  for (const auto& row : test.rows)
    text += fmt::format("{:.8g},{:.8g},{},{:.8g}\n", row.strain, row.stress, row.broken_bonds,
                        row.lateral_strain);
  write_text(path, text);
}

void write_field(const fs::path& path, const TrueTest& test) {
  std::string text = "x_um,y_um,z_um,ux_um,uy_um,uz_um\n";
  for (std::size_t k = 0; k < test.scan.displacement.size(); ++k) {
    const Vec3 at = 1e6 * test.packing.beads[k].centre, moved = 1e6 * test.scan.displacement[k];
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", at.x(), at.y(), at.z(), moved.x(),
                        moved.y(), moved.z());
  }
  write_text(path, text);
}

void run(const Split& split, std::size_t number, const std::string& engine, std::uint64_t member,
         const fs::path& out, std::map<std::string, double> effects) {
  const SharedPacking& packing = split.packings.at(number - 1);
  CasePlan plan;
  plan.name = out.filename().string();
  plan.packing = number - 1;
  plan.effects = std::move(effects);
  if (engine != "own") plan.engine = engine;
  const Sample believed = believed_a(split, packing);
  const std::uint64_t seed = random_bits(packing.seed, 0) >> 1;
  Packing beads = reported_beads(plan, split, believed, seed, 0);
  if (member > 0) beads.beads = measured_beads(beads, random_bits(seed, member), split);
  const TrueTest test = run_truth(plan, split, believed, beads, 0, true, packing.scan_strain,
                                  fs::absolute(out.string() + ".run"));
  write_curve(out.string() + ".csv", test);
  write_field(out.string() + ".field.csv", test);
  write_text(
      out.string() + ".json",
      fmt::format("{{\"beads\": {}, \"bridges\": {}, \"standing_at_scan\": {}, \"engine\": \"{}\"}}\n",
                  test.packing.beads.size(), test.bodies.size(), test.scan.standing.size(), test.engine));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6 && argc != 8) {
    fmt::print(stderr, "engine_runs SPLIT.toml PACKING ENGINE MEMBER OUT [EFFECT THETA]\n");
    return 2;
  }
  try {
    std::map<std::string, double> effects;
    if (argc == 8) effects[effects::find_effect(argv[6], "engine_runs").id] = std::strtod(argv[7], nullptr);
    run(read_split(argv[1], {}), std::strtoul(argv[2], nullptr, 10), argv[3],
        std::strtoull(argv[4], nullptr, 10), argv[5], std::move(effects));
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.exit_status();
  }
}
