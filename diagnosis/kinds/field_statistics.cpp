#include "diagnosis/kinds/field_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/eigensystem.h"
#include "base/quantile.h"
#include "base/random.h"
#include "diagnosis/thresholds.h"
#include "packing/bridges.h"

namespace pendular::diagnosis {
namespace {

constexpr double kEnds = 1.25;                // mean diameters from the flat ends
constexpr double kSteep = 0.7, kFlat = 0.35;  // cosine of a pair's direction to the axis
constexpr double kPartScale = 0.2;            // µm, of how far pairs part
constexpr double kQuantiles[] = {0.5, 0.9, 0.98};
constexpr double kPairQuantiles[] = {0.02, 0.1, 0.5, 0.9, 0.98};

/// Logarithm of a root mean square whose noise has this variance.
double log_size(double mean_square, double noise) {
  return 0.5 * std::log(std::max(mean_square - noise, 0.0) + kThresholds.size_floor * noise + 1e-12);
}

double mean_square(const Eigen::VectorXd& field, const std::vector<Eigen::Index>& rows) {
  double sum = 0.0;
  for (const auto row : rows) sum += field.segment<3>(row).squaredNorm();
  return rows.empty() ? 0.0 : sum / static_cast<double>(rows.size());
}

double per_bead(const Eigen::VectorXd& field) {
  return std::sqrt(field.squaredNorm() / (static_cast<double>(field.size()) / 3.0));
}

/// The mean field of each member without any change.
std::map<int, Eigen::VectorXd> baselines_of(const std::vector<BankField>& bank) {
  std::map<int, Eigen::VectorXd> found;
  for (const auto& one : bank)
    if (one.id.empty()) found.emplace(one.member, one.values);
  return found;
}

/// What fields change by with a magnitude: the line through the origin that fits all runs, since a single run
/// is its own best mode and leaves nothing.
struct Change {
  explicit Change(Eigen::Index size) : sum(Eigen::VectorXd::Zero(size)) {}

  Eigen::VectorXd sum;  // of θ times what changed
  double theta_squares = 0.0, squares = 0.0, largest = 0.0;
  int runs = 0;

  void add(double theta, const Eigen::VectorXd& difference) {
    sum += theta * difference;
    theta_squares += theta * theta, squares += difference.squaredNorm();
    largest = std::max(largest, std::fabs(theta)), ++runs;
  }
  /// Whether the line is more than chance makes of so many runs, and large enough to be seen.
  bool repeats() const {
    const double fitted = sum.squaredNorm() / theta_squares;  // of the squares
    return runs > 1 && per_bead(sum) * largest / theta_squares > kThresholds.least_mode &&
           fitted > (kThresholds.coherent + (1.0 - kThresholds.coherent) / runs) * squares;
  }
};

}  // namespace

FieldStatistics::FieldStatistics(const FollowedBeads& followed, const std::vector<BankField>& bank)
    : followed_(followed) {
  learn_modes(bank);
  find_pairs();
  find_parts();
  for (Eigen::Index k = 0; k < modes_.cols(); ++k) names_.push_back(fmt::format("mode_{}", k + 1));
  names_.insert(names_.end(), {"field_size", "left_size", "left_median", "left_tenth", "left_fiftieth"});
  for (const auto& [name, rows] : parts_) names_.push_back("left_" + name);
  names_.insert(names_.end(), {"pairs_parting", "pairs_sliding", "parting_02", "parting_10", "parting_50",
                               "parting_90", "parting_98", "closing_share", "closing_left", "opening_share",
                               "opening_left", "steep_parting", "flat_parting"});
}

void FieldStatistics::learn_modes(const std::vector<BankField>& bank) {
  const auto baselines = baselines_of(bank);
  reference_ = Eigen::VectorXd::Zero(bank.front().values.size());
  for (const auto& [member, values] : baselines) reference_ += values / static_cast<double>(baselines.size());

  std::map<std::pair<std::string, bool>, Change> changes;  // of either sign of an id
  for (const auto& one : bank) {
    const auto own = baselines.find(one.member);
    if (one.id.empty() || own == baselines.end()) continue;
    Change& change = changes.try_emplace({one.id, one.theta < 0.0}, reference_.size()).first->second;
    change.add(one.theta, one.values - own->second);
  }
  std::vector<Eigen::VectorXd> found;
  for (const auto& [of, change] : changes)
    if (change.repeats()) found.push_back(change.sum.normalized());
  modes_ = Eigen::MatrixXd(reference_.size(), 0);
  if (found.empty()) return;
  Eigen::MatrixXd all(reference_.size(), static_cast<Eigen::Index>(found.size()));
  for (std::size_t k = 0; k < found.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = found[k];
  // Singular values that count are a twentieth of the largest and more: their squares are exact enough.
  const auto [squares, vectors] = eigensystem(all.transpose() * all);
  const Eigen::VectorXd singular = squares.cwiseMax(0.0).cwiseSqrt().reverse();
  Eigen::Index kept = 0;
  while (kept < singular.size() && singular[kept] > kThresholds.independent * singular[0]) ++kept;
  modes_ = all * vectors.rowwise().reverse().leftCols(kept) * singular.head(kept).cwiseInverse().asDiagonal();
}

void FieldStatistics::find_pairs() {
  for (const auto& pair : candidate_bridges(followed_.beads, followed_.cutoff)) {
    const Eigen::Index a = 3 * pair.i, b = 3 * pair.j;
    const Vec3 way = (followed_.beads[static_cast<std::size_t>(pair.j)].centre -
                      followed_.beads[static_cast<std::size_t>(pair.i)].centre)
                         .normalized();
    pairs_.push_back({a, b, way, (reference_.segment<3>(b) - reference_.segment<3>(a)).dot(way)});
  }
}

void FieldStatistics::find_parts() {
  const auto& beads = followed_.beads;
  const double diameter = mean_diameter(beads);
  std::vector<double> heights, radii;
  Vec3 middle = Vec3::Zero();
  for (const auto& bead : beads) middle += bead.centre / static_cast<double>(beads.size());
  for (const auto& bead : beads) {
    heights.push_back(bead.centre.z());
    radii.push_back(std::hypot(bead.centre.x() - middle.x(), bead.centre.y() - middle.y()));
  }
  const double low = lower_quantile(heights, 1.0 / 3.0), high = lower_quantile(heights, 2.0 / 3.0),
               rim = lower_quantile(radii, 0.5), bottom = lower_quantile(heights, 0.0),
               top = lower_quantile(heights, 1.0);
  parts_ = {{"low", {}}, {"middle", {}}, {"high", {}}, {"rim", {}}, {"ends", {}}};
  for (std::size_t k = 0; k < beads.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(3 * k);
    parts_[heights[k] < low ? 0 : heights[k] < high ? 1 : 2].second.push_back(row);
    if (radii[k] > rim) parts_[3].second.push_back(row);
    if (std::min(heights[k] - bottom, top - heights[k]) < kEnds * diameter) parts_[4].second.push_back(row);
  }
}

Eigen::VectorXd FieldStatistics::noise(unsigned long seed) const {
  Eigen::VectorXd values(reference_.size());
  for (Eigen::Index k = 0; k < values.size(); ++k)
    values[k] = followed_.sigma_um * random_normal(seed, static_cast<std::uint64_t>(k));
  return values;
}

Eigen::VectorXd FieldStatistics::operator()(const Eigen::VectorXd& field) const {
  const Eigen::VectorXd difference = field - reference_;
  const Eigen::VectorXd scores = modes_.transpose() * difference;
  const Eigen::VectorXd left = difference - modes_ * scores;
  const double beads = static_cast<double>(field.size()) / 3.0, noise = std::pow(followed_.sigma_um, 2);
  std::vector<double> values;
  for (const double score : scores) values.push_back(score / std::sqrt(beads));
  values.push_back(log_size(difference.squaredNorm() / beads, 3.0 * noise));
  values.push_back(log_size(left.squaredNorm() / beads, 3.0 * noise));
  std::vector<double> sizes;
  for (Eigen::Index row = 0; row < left.size(); row += 3) sizes.push_back(left.segment<3>(row).norm());
  for (const double size : lower_quantiles(std::move(sizes), kQuantiles))
    values.push_back(0.5 * std::log(size * size + kThresholds.size_floor * noise + 1e-12));
  for (const auto& [name, rows] : parts_) values.push_back(log_size(mean_square(left, rows), 3.0 * noise));

  std::vector<double> parting;
  double along = 0.0, across = 0.0, steep = 0.0, flat = 0.0, steeps = 0.0, flats = 0.0;
  double product[2] = {0.0, 0.0}, square[2] = {0.0, 0.0}, kept[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
  for (const auto& pair : pairs_) {
    const Vec3 apart = left.segment<3>(pair.b) - left.segment<3>(pair.a);
    const double own = apart.dot(pair.way),
                 whole = (difference.segment<3>(pair.b) - difference.segment<3>(pair.a)).dot(pair.way);
    parting.push_back(own);
    along += own * own, across += apart.squaredNorm() - own * own;
    const std::size_t opens = pair.opening > 0.0;
    product[opens] += pair.opening * whole, square[opens] += pair.opening * pair.opening;
    kept[opens] += own * own, count[opens] += 1.0;
    const double cosine = std::fabs(pair.way.z());
    if (cosine > kSteep) steep += whole, steeps += 1.0;
    if (cosine < kFlat) flat += whole, flats += 1.0;
  }
  const double pairs = std::max<double>(1.0, static_cast<double>(pairs_.size()));
  values.push_back(log_size(along / pairs, 2.0 * noise));
  values.push_back(log_size(across / pairs, 4.0 * noise));
  for (const double part : lower_quantiles(std::move(parting), kPairQuantiles))
    values.push_back(std::asinh(part / kPartScale));
  for (const std::size_t opens : {0, 1}) {
    values.push_back(square[opens] > 0.0 ? product[opens] / square[opens] : 0.0);
    values.push_back(log_size(kept[opens] / std::max(1.0, count[opens]), 2.0 * noise));
  }
  values.push_back(steep / std::max(1.0, steeps));
  values.push_back(flat / std::max(1.0, flats));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace pendular::diagnosis
