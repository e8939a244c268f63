#include "packing/contact_peak.h"

#include <algorithm>
#include <cmath>

#include "packing/bridges.h"

namespace pendular {
namespace {

constexpr double kRange = 0.2;                             // of the mean diameter
constexpr double kWidths[] = {0.0015, 0.004, 0.01, 0.02};  // likewise, to start from
constexpr double kNear = 3.0, kFar = 6.0, kWindow = 4.0;   // of the peak's width, about its middle
constexpr double kLeastPairs = 50.0, kProminence = 1.5;    // of the peak over what lies beyond it
constexpr int kRounds = 200;

double normal(double u) {
  return std::exp(-0.5 * u * u) / std::sqrt(2.0 * M_PI);
}
double below(double u) {
  return 0.5 * std::erfc(-u / std::sqrt(2.0));
}

/// A peak and the pairs per length beyond it.
struct Mixture {
  double position = 0.0, width = 0.0, touching = 0.0, apart = 0.0;

  double touching_at(double gap) const { return touching / width * normal((gap - position) / width); }
  double apart_at(double gap) const { return apart * below((gap - position) / width); }
};

std::vector<double> gaps_of(const std::vector<Bridge>& pairs) {
  std::vector<double> gaps;
  for (const auto& pair : pairs) gaps.push_back(pair.gap);
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

double between(const std::vector<double>& sorted, double from, double to) {
  return static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), to) -
                             std::lower_bound(sorted.begin(), sorted.end(), from));
}

/// The middle of the interval of four widths that holds the most gaps over the one beyond it.
double densest(const std::vector<double>& gaps, double width) {
  double best = 0.0, most = -1.0;
  for (const double from : gaps) {
    const double excess =
        between(gaps, from, from + 4.0 * width) - between(gaps, from + 4.0 * width, from + 8.0 * width);
    if (excess > most) most = excess, best = from + 2.0 * width;
  }
  return best;
}

/// One round: pairs beyond the peak are counted, those within it shared out.
void improve(Mixture& m, const std::vector<double>& gaps) {
  m.apart =
      between(gaps, m.position + kNear * m.width, m.position + kFar * m.width) / ((kFar - kNear) * m.width);
  double weight = 0.0, sum = 0.0, square = 0.0;
  const double middle = m.position;
  auto gap = std::lower_bound(gaps.begin(), gaps.end(), middle - kWindow * m.width);
  for (; gap != gaps.end() && *gap <= middle + kWindow * m.width; ++gap) {
    const double touch = m.touching_at(*gap), share = touch / (touch + m.apart_at(*gap) + 1e-300);
    weight += share, sum += share * (*gap - middle), square += share * (*gap - middle) * (*gap - middle);
  }
  m.touching = weight;
  if (weight <= 0.0) return;
  m.position = middle + sum / weight;
  m.width = std::sqrt(std::max(square / weight - std::pow(sum / weight, 2), 0.0));
}

/// Logarithm of the likelihood of all gaps up to the range's end, by pairs per length.
double likelihood(const Mixture& m, const std::vector<double>& gaps, double end) {
  double sum = 0.0;
  for (const double gap : gaps) sum += std::log(m.touching_at(gap) + m.apart_at(gap) + 1e-12 / end);
  return sum - m.touching - m.apart * std::max(0.0, end - m.position);
}

double stated_scatter(const std::vector<Bridge>& pairs, const Mixture& m) {
  double square = 0.0, count = 0.0;
  for (const auto& pair : pairs)
    if (std::fabs(pair.gap - m.position) < 2.0 * m.width)
      square += pair.sigma_gap * pair.sigma_gap, count += 1.0;
  return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

}  // namespace

double ContactPeak::sigma_position() const {
  return scatter / std::sqrt(pairs);
}
double ContactPeak::sigma_scatter() const {
  return scatter / std::sqrt(2.0 * pairs);
}

std::optional<ContactPeak> contact_peak(const std::vector<std::vector<Bead>>& tables) {
  std::vector<Bridge> pairs;
  double diameter = 0.0;
  for (const auto& beads : tables) diameter += mean_diameter(beads) / static_cast<double>(tables.size());
  const double end = kRange * diameter;
  for (const auto& beads : tables) {
    const auto found = candidate_bridges(beads, end);
    pairs.insert(pairs.end(), found.begin(), found.end());
  }
  const auto gaps = gaps_of(pairs);
  std::optional<Mixture> best;
  double best_likelihood = 0.0;
  for (const double width : kWidths) {
    Mixture m{densest(gaps, width * diameter), width * diameter, static_cast<double>(gaps.size()), 0.0};
    for (int round = 0; round < kRounds && m.touching >= kLeastPairs && m.width > 1e-6 * diameter; ++round)
      improve(m, gaps);
    if (!(m.touching >= kLeastPairs) || !(m.width > 0.0) || std::fabs(m.position) > 0.5 * end) continue;
    if (m.touching_at(m.position) < kProminence * m.apart) continue;
    const double found = likelihood(m, gaps, end);
    if (!best || found > best_likelihood) best = m, best_likelihood = found;
  }
  if (!best) return std::nullopt;
  return ContactPeak{best->position, best->width, stated_scatter(pairs, *best), best->touching, diameter};
}

}  // namespace pendular
