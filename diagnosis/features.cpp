#include "diagnosis/features.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/line_fit.h"
#include "diagnosis/curve_signature.h"
#include "diagnosis/displacement_signature.h"
#include "diagnosis/funicular.h"
#include "diagnosis/perturb.h"

namespace pendular::diagnosis {
namespace {

constexpr double kLateralRange = 0.03;  // strain over which the lateral ratio is read

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> logarithms(const std::vector<double>& values) {
  std::vector<double> logs;
  for (double v : values) logs.push_back(std::log(v));
  return logs;
}

bool spread_out(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most > 1.2 * *least;
}

/// Collects features of one observation.
class List {
 public:
  List(const Observation& observation, Scale scale) : observation_(observation), scale_(scale) {}
  void ratio(const std::string& name, double value, double from = 0.0, double to = 0.0) {
    if (value > 0.0 && std::isfinite(value))
      all_.push_back({observation_.name, name, scale_, true, value, from, to});
  }
  void difference(const std::string& name, double value, double from = 0.0, double to = 0.0) {
    if (std::isfinite(value)) all_.push_back({observation_.name, name, scale_, false, value, from, to});
  }
  std::vector<Feature> take() { return std::move(all_); }

 private:
  const Observation& observation_;
  Scale scale_;
  std::vector<Feature> all_;
};

double last_strain(const Observation& observation) {
  const auto& strain = observation.column("strain");
  return *std::max_element(strain.begin(), strain.end());
}

void add_compression(List& list, const Observation& observation, const Columns& columns) {
  for (const auto& f :
       curve_features({columns.at("strain"), columns.at("stress_pa")}, last_strain(observation))) {
    if (f.logarithm)
      list.ratio(f.name, f.value, f.strain_from, f.strain_to);
    else
      list.difference(f.name, f.value, f.strain_from, f.strain_to);
  }
}

void add_lateral(List& list, const Observation& observation, const Columns& columns) {
  const auto &strain = columns.at("strain"), &lateral = columns.at("lateral_strain");
  const double last = last_strain(observation), range = std::min(kLateralRange, last);
  std::vector<double> x, y, late_x, late_y;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    if (strain[k] > last) continue;
    const bool early = strain[k] <= range;
    (early ? x : late_x).push_back(strain[k]);
    (early ? y : late_y).push_back(lateral[k]);
  }
  if (x.size() >= 3) list.difference("lateral_ratio", line_through(x, y).slope, 0.0, range);
  if (late_x.size() >= 3)
    list.difference("late_lateral_ratio", line_through(late_x, late_y).slope, range, last);
}

void add_series(List& list, const Columns& columns) {
  const bool by_content = columns.contains("W");
  const auto &at = columns.at(by_content ? "W" : "E_p_pa"), &modulus = columns.at("modulus_pa");
  std::vector<double> x, y, beyond;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (by_content && at[k] > kFunicularContent) {
      beyond.push_back(std::log(modulus[k]));
      continue;
    }
    x.push_back(std::log(at[k])), y.push_back(std::log(modulus[k]));
  }
  if (!y.empty()) list.ratio("modulus_level", std::exp(mean(y)));
  if (y.size() >= 2 && x.back() != x.front()) list.difference("modulus_exponent", line_through(x, y).slope);
  if (!beyond.empty()) list.ratio("modulus_beyond_funicular", std::exp(mean(beyond)));
}

void add_bridges(List& list, const Columns& columns) {
  const auto& d = columns.at("d_um");
  for (const char* stiffness : {"kn", "kt"}) {
    const auto found = columns.find(std::string(stiffness) + "_n_per_m");
    if (found == columns.end()) continue;
    const auto logs = logarithms(found->second);
    list.ratio(std::string(stiffness) + "_level", std::exp(mean(logs)));
    if (logs.size() >= 4 && spread_out(d))
      list.difference(std::string(stiffness) + "_exponent", line_through(logarithms(d), logs).slope);
  }
}

constexpr double kRounding = 1e-12;  // what remains of the spread of equal numbers

void add_diameters(List& list, const Columns& columns) {
  const auto& d = columns.at("d_um");
  const double middle = mean(d);
  double square = 0.0;
  for (double one : d) square += (one - middle) * (one - middle);
  list.ratio("diameter_mean", middle);
  const double spread = std::sqrt(square / static_cast<double>(d.size() - 1)) / middle;
  list.difference("diameter_spread", spread > kRounding ? spread : 0.0);
}

void add_breaks(List& list, const Observation& observation, const Columns& columns) {
  const auto &strain = columns.at("strain"), &count = columns.at("count");
  const double last = last_strain(observation);
  for (const auto& [name, share] : {std::pair("breaks_at_half", 0.5), {"breaks_at_end", 1.0}}) {
    double broken = 0.0;
    for (std::size_t k = 0; k < strain.size(); ++k)
      if (strain[k] <= share * last * (1.0 + 1e-9)) broken = std::max(broken, count[k]);
    list.ratio(name, broken + 1.0, 0.0, share * last);
  }
}

Scale scale_of(Kind kind) {
  switch (kind) {
    case Kind::bridge_stiffness:
    case Kind::bridge_diameters:
    case Kind::bridge_gaps:
      return Scale::bridge;
    case Kind::coordination:
    case Kind::displacements:
    case Kind::broken_bonds:
      return Scale::network;
    default:
      return Scale::aggregate;
  }
}

}  // namespace

std::string to_string(Scale scale) {
  static constexpr const char* kNames[] = {"bridge", "network", "aggregate"};
  return kNames[static_cast<int>(scale)];
}

std::vector<Feature> features_of(const Observation& observation, const Columns& columns) {
  List list(observation, scale_of(observation.kind));
  switch (observation.kind) {
    case Kind::compression:
      add_compression(list, observation, columns);
      break;
    case Kind::lateral_strain:
      add_lateral(list, observation, columns);
      break;
    case Kind::modulus_series:
      add_series(list, columns);
      break;
    case Kind::bridge_stiffness:
      add_bridges(list, columns);
      break;
    case Kind::bridge_diameters:
      add_diameters(list, columns);
      break;
    case Kind::bridge_gaps:
      list.difference("gap_mean_um", mean(columns.at("gap_um")));
      break;
    case Kind::coordination:
      list.ratio("coordination", mean(columns.at("z")));
      break;
    case Kind::displacements:
      for (const auto& [name, value] : displacement_signature(columns)) list.difference(name, value);
      break;
    case Kind::broken_bonds:
      add_breaks(list, observation, columns);
      break;
  }
  return list.take();
}

std::vector<double> feature_sigmas(const Observation& observation, int rounds, unsigned long seed) {
  const auto features = features_of(observation, observation.columns);
  std::vector<std::vector<double>> changes(features.size());
  for (int round = 0; round < rounds; ++round) {
    const auto again =
        features_of(observation, perturbed(observation, seed + static_cast<unsigned long>(round)));
    for (const auto& feature : again)
      for (std::size_t k = 0; k < features.size(); ++k)
        if (features[k].name == feature.name)
          changes[k].push_back(feature.logarithm ? std::log(feature.value / features[k].value)
                                                 : feature.value - features[k].value);
  }
  std::vector<double> sigmas;
  for (const auto& of_one : changes) {
    double square = 0.0;
    const double middle = of_one.empty() ? 0.0 : mean(of_one);
    for (double change : of_one) square += (change - middle) * (change - middle);
    sigmas.push_back(of_one.size() < 2 ? 0.0 : std::sqrt(square / static_cast<double>(of_one.size() - 1)));
  }
  return sigmas;
}

}  // namespace pendular::diagnosis
