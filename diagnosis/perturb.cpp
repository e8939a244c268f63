#include "diagnosis/perturb.h"

#include <cmath>

#include "base/random.h"
#include "diagnosis/curve_signature.h"

namespace pendular::diagnosis {
namespace {

/// Moves a column by normal noise of a standard deviation per row.
void move(std::vector<double>& values, const std::vector<double>& sigma, unsigned long seed) {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] += sigma[k] * random_normal(seed, k);
}

void move_by_column(Columns& columns, const std::string& value, const std::string& sigma,
                    unsigned long seed) {
  if (columns.contains(value) && columns.contains(sigma)) move(columns[value], columns.at(sigma), seed);
}

/// Rows drawn again, with replacement.
void draw_again(Columns& columns, unsigned long seed) {
  const Columns original = columns;
  for (auto& [name, column] : columns)
    for (std::size_t k = 0; k < column.size(); ++k) {
      const auto row = static_cast<std::size_t>(random_uniform(seed, k) * static_cast<double>(column.size()));
      column[k] = original.at(name)[row];
    }
}

void move_curve(Columns& columns, const std::string& value, const std::string& sigma, unsigned long seed) {
  if (columns.contains(sigma)) return move_by_column(columns, value, sigma, seed);
  const double noise = curve_noise({columns.at("strain"), columns.at(value)});
  move(columns[value], std::vector<double>(columns[value].size(), noise), seed);
}

}  // namespace

Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  switch (observation.kind) {
    case Kind::compression:
      move_curve(columns, "stress_pa", "stress_sigma_pa", seed);
      break;
    case Kind::lateral_strain:
      move_curve(columns, "lateral_strain", "sigma", seed);
      break;
    case Kind::modulus_series:
      move_by_column(columns, "modulus_pa", "modulus_sigma_pa", seed);
      break;
    case Kind::bridge_stiffness:
      move_by_column(columns, "kn_n_per_m", "kn_sigma_n_per_m", seed);
      move_by_column(columns, "kt_n_per_m", "kt_sigma_n_per_m", seed + 0x10000);
      break;
    case Kind::coordination:
      move_by_column(columns, "z", "z_sigma", seed);
      break;
    case Kind::bridge_diameters:
    case Kind::bridge_gaps:
    case Kind::displacements:
      draw_again(columns, seed);
      break;
    case Kind::broken_bonds: {
      // Counts rise from row to row: what is added between rows scatters.
      auto& count = columns["count"];
      double moved = 0.0, before = 0.0;
      for (std::size_t k = 0; k < count.size(); ++k) {
        const double more = std::max(0.0, count[k] - before);
        before = count[k];
        moved += std::max(0.0, more + std::sqrt(more) * random_normal(seed, k));
        count[k] = moved;
      }
      break;
    }
  }
  return columns;
}

}  // namespace pendular::diagnosis
