#include "blind/truth.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "blind/engine_truth.h"
#include "blind/mechanism.h"
#include "diagnosis/experiment/believed.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "packing/polydata.h"
#include "run_folder/frame.h"

namespace pendular::blind {
namespace {

constexpr double kBeyond = 1.03;     // of the last strain that is to be read
constexpr double kFarBeyond = 1.35;  // where readings differ from what is
constexpr double kProbe = 1.5;       // likewise, of the strain at which to unload

/// Whether strain is read otherwise than it is.
bool misread(const CasePlan& plan) {
  if (!plan.mechanism.empty()) return find_mechanism(plan.mechanism, plan.name).rows != nullptr;
  return std::any_of(plan.effects.begin(), plan.effects.end(), [&](const auto& item) {
    return effects::find_effect(item.first, plan.name).rows != nullptr;
  });
}

/// The hooks of the case's mechanism.
dem_core::CompressOptions hooks(const CasePlan& plan) {
  dem_core::CompressOptions options;
  if (plan.mechanism.empty()) return options;
  const Mechanism& mechanism = find_mechanism(plan.mechanism, plan.name);
  const double theta = plan.mechanism_theta;
  if (mechanism.simulation)
    options.prepare = [&mechanism, theta](dem_core::Simulation& simulation) {
      mechanism.simulation(simulation, theta);
    };
  if (mechanism.evolution) options.evolution = {mechanism.memory, mechanism.evolution(theta)};
  if (mechanism.rows)
    options.read_rows = [&mechanism, theta](std::vector<CurveRow>& rows,
                                            const dem_core::Simulation& simulation) {
      mechanism.rows(rows, simulation, theta);
    };
  return options;
}

/// Of the draws in a specimen's test.
std::uint64_t run_seed(const CasePlan& plan, std::uint64_t number) {
  return random_bits(plan.seed, number) >> 1;
}

Scan read_scan(const fs::path& path) {
  const RunFrame frame = run_frame(read_polydata(path), path);
  Scan scan;
  scan.displacement = frame.displacement;
  for (std::size_t k = 0; k < frame.pairs.size(); ++k)
    if (frame.lines[k] == RunFrame::Line::bond)
      scan.standing.insert(std::minmax(frame.pairs[k][0], frame.pairs[k][1]));
  return scan;
}

/// One test of a case's specimen.
class Bench {
 public:
  Bench(const CasePlan& plan, const Packing& beads, const Sample& sample, std::uint64_t seed,
        const fs::path& scratch)
      : plan_(plan), beads_(beads), sample_(sample), seed_(seed), scratch_(scratch) {}

  std::vector<CurveRow> compress(double max_strain, std::vector<double> unload_at) const {
    Sample sample = sample_;
    sample.compression.max_strain = max_strain;
    sample.compression.unload_at = std::move(unload_at);
    return compress(sample);
  }

  /// The specimen where the strain that is read is the scan's.
  Scan scan(double read) const {
    const double true_strain = misread(plan_) ? strain_reading(read, compress(kProbe * read, {})) : read;
    Sample sample = sample_;
    sample.compression.frame_at = {true_strain};
    sample.compression.max_strain = 1.01 * true_strain;
    Scan scan;
    compress(sample, &scan);
    return scan;
  }

  /// The strain at which to turn so that the instruments' last row before it reads this one, from a test
  /// without unloading. Rows are equal times at constant speed, and the last ends the test, whatever was made
  /// of their strains.
  double turn_reading(double wanted) const {
    const double end = kProbe * wanted, row = 1.0 / sample_.compression.rows_per_strain;
    const auto rows = compress(end, {});
    return strain_reading(wanted, rows) + row;  // the row in which the platen turns is short of the turn
  }

 private:
  /// The true strain at which these rows of a test to kProbe × `wanted` read the wanted one; its end where
  /// they never do.
  double strain_reading(double wanted, const std::vector<CurveRow>& rows) const {
    const double end = kProbe * wanted, row = 1.0 / sample_.compression.rows_per_strain;
    std::size_t k = 0;
    while (k < rows.size() && rows[k].strain < wanted) ++k;
    if (k == 0 || k == rows.size()) return end;
    const double share = (wanted - rows[k - 1].strain) / (rows[k].strain - rows[k - 1].strain);
    return end - (static_cast<double>(rows.size() - k) + 0.5 - share) * row;  // a row is a mean
  }

  std::vector<CurveRow> compress(const Sample& sample, Scan* scan = nullptr) const {
    fs::remove_all(scratch_);
    make_folder(scratch_.parent_path());
    auto rows = effects::compress_with_effects(beads_, sample, seed_, scratch_, hooks(plan_)).rows;
    if (scan) *scan = read_scan(frame_files(scratch_).at(0));
    fs::remove_all(scratch_);
    return rows;
  }

  const CasePlan& plan_;
  const Packing& beads_;
  const Sample& sample_;
  std::uint64_t seed_;
  fs::path scratch_;
};

}  // namespace

Packing reported_beads(const CasePlan& plan, const Split& split, const Sample& believed, std::uint64_t seed,
                       std::uint64_t number) {
  Packing packing = generate_packing(believed, seed);
  for (auto& bead : packing.beads)
    bead.sigma_centre = split.sigma_centre, bead.sigma_diameter = split.sigma_diameter;
  packing.bridges = candidate_bridges(packing.beads, believed.bridges.cutoff * believed.beads.diameter);
  return effects::reading(packing, true_sample(plan, split, believed), run_seed(plan, number));
}

std::vector<Bead> measured_beads(const Packing& reported, std::uint64_t seed, const Split& split) {
  const std::uint64_t draws = random_bits(seed, 0x6d656173);
  std::vector<Bead> beads = reported.beads;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      beads[k].centre[axis] += split.sigma_centre * random_normal(draws, 4 * k + static_cast<unsigned>(axis));
    beads[k].diameter += split.sigma_diameter * random_normal(draws, 4 * k + 3);
  }
  return beads;
}

Sample true_sample(const CasePlan& plan, const Split& split, const Sample& believed) {
  Sample sample = diagnosis::changed_sample(believed, [&](Sample& changed) {
    for (const auto& [key, offset] : plan.offsets) {
      // The sd is of A's value; another specimen is off by the same share.
      const double stated = sample_key(split.sample, key);
      const double share = stated != 0.0 ? sample_key(changed, key) / stated : 1.0;
      set_sample_key(changed, key, sample_key(changed, key) + share * offset * split.uncertainty.at(key));
    }
  });
  for (const auto& [key, value] : laws().at(plan.law)) set_sample_key(sample, key, value, plan.name);
  if (!plan.engine.empty())
    for (const auto& [key, value] : find_engine(plan.engine, plan.name).settings)
      set_sample_key(sample, key, value, plan.name);
  sample.effects = plan.effects;
  return sample;
}

TrueTest run_truth(const CasePlan& plan, const Split& split, const Sample& believed, const Packing& beads,
                   std::uint64_t number, bool unload, double scan_at, const fs::path& scratch) {
  TrueTest test;
  test.sample = true_sample(plan, split, believed);
  test.sample.compression.frames = 0.0;
  const std::uint64_t seed = run_seed(plan, number);
  if (!plan.engine.empty()) {
    const Engine& engine = find_engine(plan.engine, plan.name);
    if (engine.outside()) {
      const double end = kBeyond * split.max_strain;
      return engine_truth({engine, beads, test.sample, seed, end, unload ? split.unload_at : 0.0, scan_at},
                          scratch);
    }
    test.engine = engine.name;
  }
  Packing packing = beads;
  if (!plan.mechanism.empty())
    if (const Mechanism& mechanism = find_mechanism(plan.mechanism, plan.name); mechanism.packing)
      mechanism.packing(packing, plan.mechanism_theta);
  const auto specimen = effects::actual_specimen(packing, test.sample, seed);
  test.packing = specimen.packing;
  test.bodies = specimen.bodies;

  const Bench bench(plan, packing, test.sample, seed, scratch);
  std::vector<double> turns;
  if (unload) turns = {misread(plan) ? bench.turn_reading(split.unload_at) : split.unload_at};
  if (scan_at > 0.0) test.scan = bench.scan(scan_at);
  test.rows = bench.compress((misread(plan) ? kFarBeyond : kBeyond) * split.max_strain, turns);
  return test;
}

}  // namespace pendular::blind
