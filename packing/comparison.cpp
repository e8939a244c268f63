#include "packing/comparison.h"

#include <cmath>

#include "packing/neighbours.h"

namespace pendular {

BeadComparison compare_beads(const std::vector<Bead>& truth, const std::vector<Bead>& found) {
  BeadComparison result;
  result.truth = truth.size();
  result.found = found.size();
  std::vector<Vec3> centres;
  std::vector<double> quarters;  // spheres of half the matching distance: pairs that touch are within it
  double largest = 0.0;
  for (const auto& bead : truth) largest = std::max(largest, bead.diameter);
  for (const auto* beads : {&truth, &found})
    for (const auto& bead : *beads) centres.push_back(bead.centre), quarters.push_back(0.25 * largest);

  constexpr int kNone = -1;
  std::vector<int> nearest_found(truth.size(), kNone), nearest_true(found.size(), kNone);
  const int split = static_cast<int>(truth.size());
  const auto distance = [&](int t, int f) { return (truth[t].centre - found[f].centre).norm(); };
  for (const auto& [a, b] : pairs_within(centres, quarters, 0.0)) {
    if (a >= split || b < split) continue;
    const int t = a, f = b - split;
    if (distance(t, f) > 0.25 * truth[t].diameter) continue;
    if (nearest_found[t] == kNone || distance(t, f) < distance(t, nearest_found[t])) nearest_found[t] = f;
    if (nearest_true[f] == kNone || distance(t, f) < distance(nearest_true[f], f)) nearest_true[f] = t;
  }
  double diameter_square = 0.0;
  for (int t = 0; t < split; ++t) {
    const int f = nearest_found[t];
    if (f == kNone || nearest_true[f] != t) continue;
    ++result.matched;
    const Vec3 error = found[f].centre - truth[t].centre;
    const double diameter_error = found[f].diameter - truth[t].diameter;
    result.centre_bias += error;
    result.centre_rms += error.cwiseAbs2();
    result.diameter_bias += diameter_error;
    diameter_square += diameter_error * diameter_error;
  }
  result.invented = result.found - result.matched;
  if (result.matched == 0) return result;
  const double n = static_cast<double>(result.matched);
  result.centre_bias /= n;
  result.centre_rms = (result.centre_rms / n).cwiseSqrt();
  result.diameter_bias /= n;
  result.diameter_rms = std::sqrt(diameter_square / n);
  return result;
}

}  // namespace pendular
