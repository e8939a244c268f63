#include "blind/logger.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace pendular::blind {
namespace {

constexpr double kTurn = 5e-4;  // strain by which a platen that turned must have moved

using Rows = std::span<const CurveRow>;

/// The row after which the platen turns, from `first` on; the last row where it does not.
std::size_t turn_after(Rows rows, std::size_t first, double direction) {
  std::size_t farthest = first;
  for (std::size_t k = first; k < rows.size(); ++k) {
    if (direction * (rows[k].strain - rows[farthest].strain) > 0.0) farthest = k;
    if (direction * (rows[farthest].strain - rows[k].strain) > kTurn) return farthest;
  }
  return rows.size() - 1;
}

CurveRow between(const CurveRow& a, const CurveRow& b, double strain) {
  const double way = b.strain - a.strain, share = way != 0.0 ? (strain - a.strain) / way : 0.0;
  CurveRow row = a;
  row.strain = strain;
  for (double CurveRow::*field :
       {&CurveRow::stress, &CurveRow::stress_bottom, &CurveRow::broken_bonds, &CurveRow::lateral_strain})
    row.*field = a.*field + share * (b.*field - a.*field);
  return row;
}

/// The row of a branch at a strain, where it first comes there; its ends count for what lies beyond.
CurveRow row_at(Rows branch, double strain, double direction) {
  std::size_t k = 0;
  while (k < branch.size() && direction * (branch[k].strain - strain) < 0.0) ++k;
  if (k > 0 && k < branch.size()) return between(branch[k - 1], branch[k], strain);
  CurveRow row = k == 0 ? branch.front() : branch.back();
  row.strain = strain;
  return row;
}

}  // namespace

std::vector<CurveRow> logged(const std::vector<CurveRow>& rows, double step, double last_strain) {
  std::vector<CurveRow> kept;
  if (rows.empty()) return kept;
  const auto last = std::llround(last_strain / step);
  double direction = 1.0;
  auto next = std::max(1LL, std::llround(std::ceil(rows.front().strain / step)));
  for (std::size_t first = 0; first + 1 < rows.size(); direction = -direction) {
    const std::size_t turn = turn_after(rows, first, direction);
    const Rows branch(rows.data() + first, turn - first + 1);
    // A turn is logged at the nearest step.
    for (; direction * (static_cast<double>(next) - rows[turn].strain / step) < 0.5;
         next += direction > 0 ? 1 : -1) {
      if (next > last) return kept;
      kept.push_back(row_at(branch, static_cast<double>(next) * step, direction));
    }
    next += direction > 0 ? -2 : 2;
    first = turn;
  }
  return kept;
}

std::vector<CurveRow> first_loading(const std::vector<CurveRow>& rows) {
  std::vector<CurveRow> kept;
  for (const auto& row : rows)
    if (kept.empty() || row.strain > kept.back().strain) kept.push_back(row);
  return kept;
}

}  // namespace pendular::blind
