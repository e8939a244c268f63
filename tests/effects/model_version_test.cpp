#include <fmt/format.h>

#include <array>
#include <limits>
#include <map>

#include "base/csv.h"
#include "base/model_version.h"
#include "dem_core/step/step_kernels.h"
#include "effects/list.h"
#include "packing/generate.h"
#include "places.h"
#include "tests.h"

// Small runs whose numbers are stored. They differ between instruction sets in their last digits only,
// because they end before a specimen's motion depends on these.

namespace pendular::effects::test {
namespace {

const std::string kStored = pendular::test::source_folder() + "/tests/effects/model_version.csv";
constexpr double kTolerance = 1e-6;  // relative; of the largest value of a column

const std::vector<std::string> kColumns = {"strain", "stress_pa", "broken_bonds", "elastic_j",
                                           "lateral_strain"};
using Row = std::array<double, 5>;

void add(std::map<std::string, std::vector<Row>>& runs, const std::string& name, const Packing& packing,
         Sample sample) {
  sample.compression.frames = 0;
  sample.compression.max_strain = 0.005;
  if (sample.compression.control == Control::speed) sample.compression.speed = 1e-3;
  sample.compression.rows_per_strain = 2000.0;
  for (const auto& r : run(packing, sample, 5).rows)
    runs[name].push_back({r.strain, r.stress, r.broken_bonds, r.elastic,
                          std::isfinite(r.lateral_strain) ? r.lateral_strain : -1.0});
}

/// What the model makes: a generated packing, the paper's model, its variants, and every effect by itself.
std::map<std::string, std::vector<Row>> computed() {
  std::map<std::string, std::vector<Row>> runs;
  Sample sample = sample_a();
  sample.specimen.diameter = sample.specimen.height = 1e-3;
  sample.specimen.volume_fraction = 0.55;
  for (const auto& bead : generate_packing(sample, 3).beads)
    runs["packing"].push_back({bead.centre.x(), bead.centre.y(), bead.centre.z(), bead.diameter, 0.0});

  const Packing packing = disordered(3, 3);
  Sample strong = sample_a(), weak = sample_a(), drawn = sample_a(), relaxed = sample_a(), one = sample_a();
  add(runs, "driven", packing, strong);
  weak.bridges.interfacial_energy = 0.01;
  add(runs, "weak", packing, weak);
  drawn.beads.diameters = Diameters::drawn;
  add(runs, "drawn", packing, drawn);
  relaxed.compression.control = Control::relaxation;
  add(runs, "relaxed", packing, relaxed);
  one.contact.tangential_springs = TangentialSprings::one;
  one.contact.bond_friction_limit = !one.contact.bond_friction_limit;
  add(runs, "other_law", packing, one);
  for (const auto& effect : all_effects()) {
    // Bonds are to break; but stressed before the test weak ones break at once, and loose beads' motion
    // depends on every digit.
    Sample with = effect.id == "residual_stress" ? strong : weak;
    with.bridges.polymer_content = 0.04;
    with.effects[effect.id] = 0.5 * effect.bank_to;
    add(runs, effect.id, packing, with);
  }
  return runs;
}

std::string text_of(const std::map<std::string, std::vector<Row>>& runs) {
  std::string text = fmt::format("# model {}\nrun,{}\n", kModelVersion, fmt::join(kColumns, ","));
  for (const auto& [name, rows] : runs)
    for (const auto& row : rows) text += fmt::format("{},{:.10g}\n", name, fmt::join(row, ","));
  return text;
}

std::map<std::string, std::vector<Row>> stored() {
  const CsvTable table =
      read_csv(kStored, {"run", "strain", "stress_pa", "broken_bonds", "elastic_j", "lateral_strain"});
  const auto names = table.texts("run");
  std::map<std::string, std::vector<Row>> runs;
  for (std::size_t k = 0; k < table.rows(); ++k) runs[names[k]].emplace_back();
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    const auto column = table.numbers(kColumns[c]);
    std::map<std::string, std::size_t> next;
    for (std::size_t k = 0; k < column.size(); ++k) runs[names[k]][next[names[k]]++][c] = column[k];
  }
  return runs;
}

/// The largest difference of a column over its largest value; infinite where the rows are others.
double difference(const std::vector<Row>& a, const std::vector<Row>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    double apart = 0.0, largest = 1e-300;
    for (std::size_t k = 0; k < a.size(); ++k) {
      apart = std::max(apart, std::fabs(a[k][c] - b[k][c]));
      largest = std::max(largest, std::fabs(b[k][c]));
    }
    worst = std::max(worst, apart / largest);
  }
  return worst;
}

class ModelVersion : public testing::TestWithParam<std::string> {
  void TearDown() override { dem_core::use_instruction_set(dem_core::instruction_sets().front()); }
};

TEST_P(ModelVersion, IsRaisedWithWhatTheModelComputes) {
  dem_core::use_instruction_set(GetParam());
  const auto found = computed();
  const fs::path proposed = fs::temp_directory_path() / "model_version.csv";
  const std::string what_to_do = fmt::format(
      "the model computes something else than version {}: raise kModelVersion (base/model_version.h), "
      "say so in the CHANGELOG, and store {} as {}",
      kModelVersion, proposed.string(), kStored);
  if (fs::exists(kStored) && read_text(kStored).starts_with(fmt::format("# model {}\n", kModelVersion))) {
    const auto before = stored();
    std::string changed;
    for (const auto& [name, rows] : found) {
      const double apart = before.contains(name) ? difference(rows, before.at(name)) : 0.0;
      if (!(apart < kTolerance)) changed += fmt::format("\n  {}: differs by {:.2g}", name, apart);
    }
    for (const auto& [name, rows] : before)
      if (!found.contains(name)) changed += "\n  " + name + ": is gone";
    if (changed.empty()) return;
    write_text(proposed, text_of(found));
    FAIL() << what_to_do << changed;
  }
  write_text(proposed, text_of(found));
  FAIL() << kStored << " is of another version than " << kModelVersion << ": store " << proposed.string();
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, ModelVersion, testing::ValuesIn(dem_core::instruction_sets()),
                         [](const auto& set) { return set.param; });

}  // namespace
}  // namespace pendular::effects::test
