#include "sweep/tables.h"

#include <cmath>
#include <limits>

#include "base/csv.h"
#include "base/error.h"
#include "run_folder/run_folder.h"

namespace pendular::sweep {
namespace {

/// A column and what it shows of a run; summed up over realisations or not.
struct Quantity {
  const char* name;
  std::optional<double> (*of)(const RunResult& run);
  bool summed;
};

template <auto member>
std::optional<double> number(const RunResult& run) {
  return run.*member;
}

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> all = {
      {"linear_modulus_pa", number<&RunResult::modulus>, true},
      {"linear_modulus_sigma_pa", number<&RunResult::modulus_sigma>, false},
      {"linear_limit_strain", number<&RunResult::linear_limit>, true},
      {"peak_stress_pa", number<&RunResult::peak_stress>, true},
      {"peak_strain", number<&RunResult::peak_strain>, true},
      {"broken_bonds", number<&RunResult::broken_bonds>, true},
      {"coordination", number<&RunResult::coordination>, true},
      {"beads", number<&RunResult::beads>, false},
      {"bonds", number<&RunResult::bonds>, false},
      {"final_strain", number<&RunResult::final_strain>, false},
      {"inertial_number", number<&RunResult::inertial_number>, false},
      {"unbalanced_force", number<&RunResult::unbalanced_force>, false},
      {"work_balance_error", number<&RunResult::work_balance_error>, false},
  };
  return all;
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One value per quantity, NaN where a run has none.
using Values = std::vector<double>;

Values values_of(const RunOutcome& outcome) {
  Values values(quantities().size(), kNone);
  if (outcome.status != RunStatus::done) return values;
  try {
    const RunResult result = read_result(outcome.folder / run_file::kResult);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = quantities()[k].of(result).value_or(kNone);
  } catch (const BadInput& error) {
    bad_input("{}; remove its folder, and the sweep makes it anew", error.what());
  }
  return values;
}

/// "point,KEY,KEY"
std::string point_header(const Plan& plan) {
  std::string text = "point";
  for (const auto& key : plan.keys) text += ',' + key;
  return text;
}

std::string point_cells(const Plan::Run& run) {
  std::string text = std::to_string(run.point);
  for (const auto& value : run.values) text += ',' + csv_cell(to_string(value));
  return text;
}

std::string results_csv(const Plan& plan, std::span<const RunOutcome> outcomes,
                        const std::vector<Values>& values) {
  std::string text = point_header(plan) + ",realisation,seed,run,status,message";
  for (const auto& quantity : quantities()) text += fmt::format(",{}", quantity.name);
  text += '\n';
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    const auto& run = plan.runs[k];
    text += fmt::format("{},{},{},{},{},{}", point_cells(run), run.realisation, run.seed, outcomes[k].hash,
                        to_string(outcomes[k].status), csv_cell(outcomes[k].message));
    for (const double value : values[k]) text += ',' + csv_cell(value);
    text += '\n';
  }
  return text;
}

/// "mean,sd,standard_error,n" of the values that there are.
std::string spread_cells(const std::vector<double>& values) {
  double sum = 0.0, square = 0.0, n = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) sum += v, n += 1.0;
  const double mean = n > 0.0 ? sum / n : kNone;
  for (const double v : values)
    if (std::isfinite(v)) square += (v - mean) * (v - mean);
  const double sd = n > 1.0 ? std::sqrt(square / (n - 1.0)) : kNone;
  return fmt::format("{},{},{},{}", csv_cell(mean), csv_cell(sd), csv_cell(sd / std::sqrt(n)), n);
}

std::string summary_csv(const Plan& plan, std::span<const RunOutcome> outcomes,
                        const std::vector<Values>& values) {
  std::string text = point_header(plan) + ",runs,failed";
  for (const auto& quantity : quantities())
    if (quantity.summed) text += fmt::format(",{0}_mean,{0}_sd,{0}_standard_error,{0}_n", quantity.name);
  text += '\n';
  for (std::size_t first = 0, last = 0; first < plan.runs.size(); first = last) {
    int failed = 0;
    for (last = first; last < plan.runs.size() && plan.runs[last].point == plan.runs[first].point; ++last)
      failed += outcomes[last].status == RunStatus::failed;
    text += fmt::format("{},{},{}", point_cells(plan.runs[first]), last - first, failed);
    for (std::size_t q = 0; q < quantities().size(); ++q) {
      if (!quantities()[q].summed) continue;
      std::vector<double> column;
      for (std::size_t k = first; k < last; ++k) column.push_back(values[k][q]);
      text += ',' + spread_cells(column);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void write_tables(const fs::path& folder, const Plan& plan, std::span<const RunOutcome> outcomes,
                  const Provenance& provenance) {
  std::vector<Values> values;
  for (const auto& outcome : outcomes) values.push_back(values_of(outcome));
  const std::string head = to_comment(provenance);
  write_text(folder / "results.csv", head + results_csv(plan, outcomes, values));
  write_text(folder / "summary.csv", head + summary_csv(plan, outcomes, values));
}

}  // namespace pendular::sweep
