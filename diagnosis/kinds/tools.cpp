#include "diagnosis/kinds/tools.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include "base/error.h"
#include "base/line_fit.h"
#include "base/quantile.h"
#include "base/random.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr double kOther = 0.05, kOtherDifference = 0.03;  // errors of features without a name of their own
constexpr double kLeastModulus = 0.1, kLargestModulus = 1e3;  // over the polymer's
constexpr double kLargestStrain = 0.6;
constexpr double kWiderLater = 0.06;  // share of a strain within which rows are read together

}  // namespace

void FeatureList::ratio(const std::string& name, double value, double from, double to) {
  if (value > 0.0 && std::isfinite(value))
    all_.push_back({observation_, name, scale_, true, value, from, to});
}

void FeatureList::difference(const std::string& name, double value, double from, double to) {
  if (std::isfinite(value)) all_.push_back({observation_, name, scale_, false, value, from, to});
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> logarithms_of(const std::vector<double>& values) {
  std::vector<double> logs;
  for (double v : values) logs.push_back(std::log(v));
  return logs;
}

double largest_of(const std::vector<double>& values) {
  double found = 0.0;
  for (double v : values) found = std::max(found, std::fabs(v));
  return found;
}

double last_strain(const Observation& observation) {
  const auto& strain = observation.column("strain");
  return *std::max_element(strain.begin(), strain.end());
}

std::vector<double> spread_about(double mean, double sd, std::size_t count) {
  const double n = static_cast<double>(count);
  std::vector<double> values;
  double square = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    values.push_back((static_cast<double>(k) + 0.5) / n - 0.5);
    square += values.back() * values.back();
  }
  const double scale = square > 0.0 ? sd / std::sqrt(square / (n - 1.0)) : 0.0;
  for (double& value : values) value = mean + scale * value;
  return values;
}

std::vector<double> read_at(const std::vector<double>& x, const std::vector<double>& y,
                            const std::vector<double>& strains, double half) {
  std::vector<double> first_x, first_y;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (first_x.empty() || x[k] > first_x.back()) first_x.push_back(x[k]), first_y.push_back(y[k]);
  std::vector<double> found;
  for (double strain : strains) {
    if (first_x.size() < 2 || strain > first_x.back() * (1.0 + 1e-3)) {
      found.push_back(std::nan(""));
      continue;
    }
    const double reach = std::max(half, kWiderLater * strain);
    auto from = std::lower_bound(first_x.begin(), first_x.end(), strain - reach);
    auto to = std::upper_bound(first_x.begin(), first_x.end(), strain + reach);
    while (to - from < 4 && (from != first_x.begin() || to != first_x.end())) {
      if (from != first_x.begin()) --from;
      if (to != first_x.end()) ++to;
    }
    const auto at = static_cast<std::size_t>(from - first_x.begin()),
               count = static_cast<std::size_t>(to - from);
    found.push_back(line_through(std::span(first_x).subspan(at, count), std::span(first_y).subspan(at, count))
                        .at(strain));
  }
  return found;
}

std::vector<double> strains_up_to(const std::vector<double>& all, double last) {
  std::vector<double> strains;
  for (double strain : all)
    if (strain <= last * (1.0 + 1e-3)) strains.push_back(strain);
  return strains;
}

void add_noise(std::vector<double>& values, const std::vector<double>& sigma, unsigned long seed,
               double correlation) {
  const std::uint64_t lasting = random_bits(seed, 0x6c617374);
  double last = random_normal(lasting, values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (correlation <= 0.0) {
      values[k] += sigma[k] * random_normal(seed, k);
      continue;
    }
    last = correlation * last + std::sqrt(1.0 - correlation * correlation) * random_normal(lasting, k);
    values[k] += sigma[k] * M_SQRT1_2 * (last + random_normal(seed, k));
  }
}

void add_stated_noise(Columns& columns, const std::string& value, const std::string& sigma,
                      unsigned long seed) {
  if (!columns.contains(value) || !columns.contains(sigma)) return;
  auto& values = columns.at(value);
  std::vector<double> logs = logarithms_of(values), shares = columns.at(sigma);
  for (std::size_t k = 0; k < shares.size(); ++k) shares[k] /= values[k];
  add_noise(logs, shares, seed);
  for (std::size_t k = 0; k < logs.size(); ++k)
    if (std::isfinite(logs[k])) values[k] = std::exp(logs[k]);
}

void draw_again(std::vector<double>& column, const std::vector<std::size_t>& rows, unsigned long seed) {
  const std::vector<double> original = column;
  for (const std::size_t k : rows) {
    const double drawn = random_uniform(seed, k) * static_cast<double>(rows.size());
    column[k] = original[rows[static_cast<std::size_t>(drawn)]];
  }
}

void draw_rows_again(Columns& columns, unsigned long seed) {
  for (auto& [name, column] : columns) {
    std::vector<std::size_t> rows(column.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    draw_again(column, rows, seed);
  }
}

void misstate(std::vector<double>& sigma, unsigned long seed) {
  const double factor = std::exp(kThresholds.stated_error * random_normal(seed, 0x66616374));
  for (double& one : sigma) one *= factor;
}

void check_strain(const Observation& observation, const std::string& column) {
  const double found = largest_of(observation.column(column));
  if (found > kLargestStrain)
    bad_input(
        "{}: {}: found values up to {:.4g}, expected fractions below 0.6 (is it in per cent, or a "
        "displacement in mm or um?)",
        observation.file.string(), column, found);
  if (found == 0.0)
    bad_input("{}: {}: found only zeros, expected a test that strains", observation.file.string(), column);
}

void check_rising(const Observation& observation, const std::string& column) {
  const auto& values = observation.column(column);
  const auto falls = std::adjacent_find(values.begin(), values.end(), std::greater<>());
  if (falls != values.end())
    bad_input("{}: {}: found {:.4g} after {:.4g}, expected the rows of first loading in order of time",
              observation.file.string(), column, *std::next(falls), *falls);
}

void check_sigma(const Observation& observation, const std::string& column, double most) {
  if (!observation.has(column)) return;
  const double found = largest_of(observation.column(column));
  if (found > most)
    bad_input(
        "{}: {}: found {:.3g}, expected standard deviations of no more than {:.3g} (the size of what was "
        "measured)",
        observation.file.string(), column, found, most);
}

void check_length(const Observation& observation, const std::string& column, double least, double most) {
  const double middle = median(observation.column(column));
  if (middle >= least && middle <= most) return;
  const char* unit = middle * 1e3 >= least && middle * 1e3 <= most   ? " (is it in mm?)"
                     : middle * 1e6 >= least && middle * 1e6 <= most ? " (is it in m?)"
                                                                     : "";
  bad_input("{}: {}: found a median of {:.4g} um, expected {:.3g} to {:.3g} um for these beads{}",
            observation.file.string(), column, middle, least, most, unit);
}

void check_modulus(const Observation& observation, const std::string& column, double modulus,
                   double polymer) {
  const double share = modulus / polymer;
  if (share > kLeastModulus && share < kLargestModulus) return;
  bad_input(
      "{}: {}: found a stiffness of {:.3g} Pa, {:.2g} times the polymer's {:.3g} Pa; expected some ten times "
      "(is the column in {}?)",
      observation.file.string(), column, modulus, share, polymer, share < 1.0 ? "MPa or kPa" : "mPa");
}

Eigen::MatrixXd errors_by_name(const std::vector<Feature>& features,
                               const std::map<std::string, double>& errors) {
  Eigen::VectorXd size(static_cast<Eigen::Index>(features.size()));
  for (std::size_t k = 0; k < features.size(); ++k) {
    const std::string& name = features[k].name;
    const auto end = name.find_last_not_of("0123456789");
    const bool later = end + 1 < name.size() && name[end] == '_';
    const auto found = errors.find(later ? name.substr(0, end) : name);
    size[static_cast<Eigen::Index>(k)] = found != errors.end()   ? found->second
                                         : features[k].logarithm ? kOther
                                                                 : kOtherDifference;
  }
  return size.cwiseAbs2().asDiagonal();
}

Eigen::MatrixXd errors_along(const Eigen::VectorXd& size, double reach) {
  Eigen::MatrixXd covariance(size.size(), size.size());
  for (Eigen::Index a = 0; a < size.size(); ++a)
    for (Eigen::Index b = 0; b < size.size(); ++b)
      covariance(a, b) = size[a] * size[b] * std::exp(-std::fabs(static_cast<double>(a - b)) / reach);
  return covariance;
}

}  // namespace pendular::diagnosis
