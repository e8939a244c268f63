#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/quantile.h"
#include "base/random.h"
#include "diagnosis/kinds/evenness.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/kinds/tools.h"
#include "effects/list.h"
#include "packing/bridges.h"
#include "packing/packing.h"
#include "packing/tables.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr double kSteep = 0.7, kFlat = 0.35;  // cosine of a pair's direction to the axis
constexpr std::size_t kLeastPairs = 20, kLeastNecks = 10;
constexpr double kFarPair = 0.3;                           // gap over bead diameter, of the median pair
constexpr double kUnevenShare = 0.01, kUnevenNeck = 0.02;  // rms by place, of a scan's own artefacts
constexpr double kShareError = 0.005, kNeckError = 0.005;  // of the simulation

/// Where pairs are in a specimen, as columns.
class Places {
 public:
  explicit Places(const std::vector<Bead>& beads) {
    for (const auto& bead : beads) {
      by_id_[bead.id] = &bead;
      box_.extend(bead.centre);
    }
  }

  void add(Columns& columns, std::int64_t id_i, std::int64_t id_j) const {
    const Bead &a = *by_id_.at(id_i), &b = *by_id_.at(id_j);
    const Vec3 at = 0.5 * (a.centre + b.centre) - box_.center(), way = (b.centre - a.centre).normalized();
    const Vec3 place = at.cwiseQuotient(box_.sizes());
    columns["across_x"].push_back(place.x()), columns["across_y"].push_back(place.y());
    columns["along_z"].push_back(place.z());
    columns["cosine"].push_back(std::fabs(way.z()));
    columns["height"].push_back(at.z() / box_.sizes().z() + 0.5);
    columns["radius"].push_back(2.0 * std::hypot(at.x(), at.y()) / box_.sizes().x());
    columns["separation_um"].push_back(kUm * gap(a, b));
  }

 private:
  std::map<std::int64_t, const Bead*> by_id_;
  Eigen::AlignedBox3d box_;
};

/// The network as columns: pairs, where they are, and whether a bridge joins them (NaN: undetermined).
void read(Observation& observation, const CsvTable& table) {
  if (observation.beads.empty())
    bad_input("{}: found no key \"beads\" beside it, expected the beads that its pairs join",
              observation.file.string());
  const auto beads = read_beads(observation.beads);
  read_bridges(observation.file, beads);
  const Places places(beads);
  const auto ids_i = table.integers("bead_i"), ids_j = table.integers("bead_j");
  auto& columns = observation.columns;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const BridgeState state =
        table.has("state") ? bridge_state(table.texts("state")[k]) : BridgeState::bridge;
    if (state == BridgeState::candidate)
      bad_input(
          "{}: column state: found \"candidate\", expected what was measured (pendular segment --bridges)",
          table.where(k));
    columns["joined"].push_back(state == BridgeState::undetermined ? std::nan("")
                                                                   : double(state == BridgeState::bridge));
    places.add(columns, ids_i[k], ids_j[k]);
  }
}

/// Adds the pairs that a table of bridges alone says to have none. They are as often a bridge that was not
/// seen as listed ones are none.
void add_pairs_without(double cutoff, Observation& observation, std::vector<std::string>& warnings) {
  const auto beads = read_beads(observation.beads);
  const auto without =
      pairs_without(beads, read_bridges(observation.file, beads), cutoff * mean_diameter(beads));
  if (without.empty()) return;
  warnings.push_back(
      fmt::format("{}: every pair that is listed has a bridge; {} near pairs of its beads that are not "
                  "listed count as without",
                  observation.name, without.size()));
  auto& columns = observation.columns;
  const Places places(beads);
  const double missed = columns.contains("probability") ? 1.0 - mean_of(columns.at("probability")) : 0.0;
  for (const Bridge& pair : without) {
    const auto id_i = beads[static_cast<std::size_t>(pair.i)].id,
               id_j = beads[static_cast<std::size_t>(pair.j)].id;
    columns["joined"].push_back(0.0);
    places.add(columns, id_i, id_j);
    const std::map<std::string, double> stated = {{"bead_i", static_cast<double>(id_i)},
                                                  {"bead_j", static_cast<double>(id_j)},
                                                  {"gap_um", kUm * pair.gap},
                                                  {"sigma_gap_um", kUm * pair.sigma_gap},
                                                  {"probability", missed}};
    for (const auto& name : observation.kind->required) columns[name].push_back(stated.at(name));
    for (const auto& name : observation.kind->optional)
      if (columns.contains(name)) columns[name].push_back(stated.contains(name) ? stated.at(name) : 0.0);
  }
}

void check(const Sample& believed, Observation& observation, std::vector<std::string>& warnings) {
  if (observation.words.at("use") == "simulate" && observation.numbers.at("strain") > 0.0)
    bad_input("{}: found use = \"simulate\" of a scan at strain {:.4g}, expected one at rest (strain = 0)",
              observation.file.string(), observation.numbers.at("strain"));
  const auto& joined = observation.column("joined");
  const auto determined =
      std::count_if(joined.begin(), joined.end(), [](double one) { return std::isfinite(one); });
  if (static_cast<std::size_t>(determined) < kLeastPairs)
    bad_input("{}: found {} pairs whose state is determined, expected at least {}", observation.file.string(),
              determined, kLeastPairs);
  const double diameter = kUm * believed.beads.diameter,
               separation = median(observation.column("separation_um"));
  if (std::fabs(separation) > kFarPair * diameter)
    bad_input(
        "{}: found pairs of beads with a gap of {:.3g} um (median) in {}, expected neighbours (another "
        "specimen?)",
        observation.file.string(), separation, observation.beads.string());
  check_sigma(observation, "sigma_gap_um", diameter);
  check_sigma(observation, "sigma_bridge_diameter_um", diameter);
  if (observation.has("bridge_diameter_um")) {
    std::vector<double> necks;
    for (double d : observation.column("bridge_diameter_um"))
      if (d > 0.0) necks.push_back(d);
    Observation of_necks = observation;
    of_necks.columns = {{"bridge_diameter_um", necks}};
    if (!necks.empty()) check_length(of_necks, "bridge_diameter_um", 0.01 * diameter, 0.99 * diameter);
  }
  add_pairs_without(believed.bridges.cutoff, observation, warnings);
}

void course(const Observation& observation, Sample::Compression& course) {
  const double strain = observation.numbers.at("strain");
  course.frame_at.push_back(strain > 0.0 ? strain : kRestStrain);
}

/// The observed pairs as a simulated scan shows them; at rest also what broke before the frame counts.
Columns simulate(const Observation& observation, const Simulated& simulated) {
  const double strain = observation.numbers.at("strain");
  const Frame& frame = frame_near(*simulated.test, strain > 0.0 ? strain : kRestStrain);
  Columns columns = observation.columns;
  const auto &i = columns.at("bead_i"), &j = columns.at("bead_j");
  auto& joined = columns.at("joined");
  const auto among = [](const std::vector<PairOfIds>& bonds, const PairOfIds& pair) {
    return std::binary_search(bonds.begin(), bonds.end(), pair);
  };
  for (std::size_t k = 0; k < i.size(); ++k) {
    if (std::isnan(joined[k])) continue;
    const PairOfIds pair = std::minmax({static_cast<std::int64_t>(i[k]), static_cast<std::int64_t>(j[k])});
    joined[k] = among(frame.standing, pair) || (strain <= 0.0 && among(frame.broken, pair)) ? 1.0 : 0.0;
  }
  if (!columns.contains("bridge_diameter_um")) return columns;
  // Of necks a test knows only what its sample says: mean and spread.
  columns["neck_mean_um"] = {kUm * simulated.sample.bridges.diameter};
  columns["neck_spread_um"] = {effects::spread_of_bridges(simulated.sample).diameter_sd};
  return columns;
}

/// Share of the pairs of a class that bridges join.
class Shares {
 public:
  Shares(FeatureList& list, const Columns& columns, double strain)
      : list_(list), columns_(columns), strain_(strain) {}

  template <typename Belongs>
  void add(const std::string& name, const Belongs& belongs) {
    const auto& joined = columns_.at("joined");
    double pairs = 0.0, bridges = 0.0;
    for (std::size_t k = 0; k < joined.size(); ++k)
      if (std::isfinite(joined[k]) && belongs(k)) pairs += 1.0, bridges += joined[k];
    if (pairs >= static_cast<double>(kLeastPairs)) list_.difference(name, bridges / pairs, 0.0, strain_);
  }

 private:
  FeatureList& list_;
  const Columns& columns_;
  double strain_;
};

/// Mean and spread of the measured necks, their errors taken off; or what a simulation has in their place.
void add_necks(FeatureList& list, const Columns& columns) {
  if (!columns.contains("bridge_diameter_um")) return;
  if (columns.contains("neck_mean_um")) {
    list.ratio("neck_mean", columns.at("neck_mean_um").front());
    return list.difference("neck_spread",
                           columns.at("neck_spread_um").front() / columns.at("neck_mean_um").front());
  }
  std::vector<double> necks;
  double errors = 0.0, square = 0.0;
  const auto& d = columns.at("bridge_diameter_um");
  const auto sigma = columns.find("sigma_bridge_diameter_um");
  for (std::size_t k = 0; k < d.size(); ++k) {
    if (!(d[k] > 0.0) || columns.at("joined")[k] != 1.0) continue;
    necks.push_back(d[k]);
    if (sigma != columns.end()) errors += sigma->second[k] * sigma->second[k];
  }
  if (necks.size() < kLeastNecks) return;
  const double middle = mean_of(necks), n = static_cast<double>(necks.size());
  for (double neck : necks) square += (neck - middle) * (neck - middle);
  list.ratio("neck_mean", middle);
  list.difference("neck_spread", std::sqrt(std::max(0.0, square / (n - 1.0) - errors / n)) / middle);
}

std::vector<Feature> landmarks(const Observation& observation, const Columns& columns) {
  FeatureList list(observation, Scale::network);
  if (observation.words.at("use") == "simulate") return list.take();  // simulations have it, by construction
  const auto &cosine = columns.at("cosine"), &height = columns.at("height"), &radius = columns.at("radius"),
             &separation = columns.at("separation_um");
  std::vector<double> sorted = separation;
  std::sort(sorted.begin(), sorted.end());
  const double near = sorted[sorted.size() / 3], far = sorted[2 * sorted.size() / 3];
  Shares shares(list, columns, observation.numbers.at("strain"));
  shares.add("bridged_share", [](std::size_t) { return true; });
  shares.add("bridged_steep", [&](std::size_t k) { return cosine[k] > kSteep; });
  shares.add("bridged_flat", [&](std::size_t k) { return cosine[k] < kFlat; });
  shares.add("bridged_low", [&](std::size_t k) { return height[k] < 1.0 / 3.0; });
  shares.add("bridged_middle", [&](std::size_t k) { return std::fabs(height[k] - 0.5) < 1.0 / 6.0; });
  shares.add("bridged_high", [&](std::size_t k) { return height[k] > 2.0 / 3.0; });
  shares.add("bridged_rim", [&](std::size_t k) { return radius[k] > M_SQRT1_2; });
  shares.add("bridged_near", [&](std::size_t k) { return separation[k] < near; });
  shares.add("bridged_far", [&](std::size_t k) { return separation[k] > far; });
  add_necks(list, columns);
  return list.take();
}

/// In every effect that bridges at rest show they are alike in all places and directions: whether a pair has
/// one, and its neck.
Unlike unlike(const Observation& observation) {
  if (observation.numbers.at("strain") > 0.0 || observation.words.at("use") == "simulate") return {};
  const auto& joined = observation.column("joined");
  const double of_bridges = evenness(observation.columns, joined, kUnevenShare);
  double of_necks = 1.0;
  if (observation.has("bridge_diameter_um")) {
    std::vector<double> necks = observation.column("bridge_diameter_um"), found;
    for (std::size_t k = 0; k < necks.size(); ++k)
      if (necks[k] > 0.0 && joined[k] == 1.0)
        found.push_back(necks[k]);
      else
        necks[k] = std::nan("");
    if (!found.empty()) of_necks = evenness(observation.columns, necks, kUnevenNeck * mean_of(found));
  }
  const bool bridges_first = of_bridges <= of_necks;
  return {std::min(1.0, 2.0 * std::min(of_bridges, of_necks)),
          bridges_first ? "bridges are not equally frequent in all places and directions"
                        : "necks are not alike in all places and directions"};
}

/// Necks drawn again with their errors, which are off by one factor.
void draw_necks_again(Columns& columns, unsigned long seed) {
  const auto d = columns.find("bridge_diameter_um"), sigma = columns.find("sigma_bridge_diameter_um");
  if (d == columns.end()) return;
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < d->second.size(); ++k)
    if (d->second[k] > 0.0) rows.push_back(k);
  draw_again(d->second, rows, seed);
  if (sigma == columns.end()) return;
  draw_again(sigma->second, rows, seed);
  misstate(sigma->second, seed);
}

/// States change by their stated probability; necks are a sample, whose stated errors may be off.
Columns perturbed(const Observation& observation, unsigned long seed) {
  Columns columns = observation.columns;
  auto& joined = columns["joined"];
  if (columns.contains("probability"))
    for (std::size_t k = 0; k < joined.size(); ++k) {
      const double probability = columns.at("probability")[k],
                   wrong = joined[k] == 1.0 ? 1.0 - probability : probability;
      if (std::isfinite(joined[k]) && random_uniform(seed, k) < wrong) joined[k] = 1.0 - joined[k];
    }
  draw_necks_again(columns, seed + 1);
  return columns;
}

Eigen::MatrixXd model_error(const std::vector<Feature>& features) {
  Eigen::MatrixXd errors = errors_by_name(features, {{"neck_mean", kNeckError}, {"neck_spread", kNeckError}});
  for (std::size_t k = 0; k < features.size(); ++k)
    if (features[k].name.starts_with("bridged")) {
      const auto at = static_cast<Eigen::Index>(k);
      errors(at, at) = kShareError * kShareError;
    }
  return errors;
}

}  // namespace

/// The measured network of a scan, as `pendular segment --bridges` writes it, at rest or at a platen strain:
/// compared by the shares of pairs that bridges join, over orientation, place and separation, and by the
/// necks.
const Kind& kinds::bridges() {
  static const Kind kind{
      .name = "bridges",
      .required = {"bead_i", "bead_j"},
      .optional = {"gap_um", "sigma_gap_um", "probability", "bridge_diameter_um", "sigma_bridge_diameter_um"},
      .least_rows = 20,
      .scale = Scale::network,
      .strain_by = StrainBy::scan,
      .keys = {{"strain", {}, 0.0, 0.5, 0.0}, {"use", {"compare", "simulate"}}},
      .read = read,
      .check = check,
      .course = course,
      .simulate = simulate,
      .landmarks = landmarks,
      .unlike = unlike,
      .perturbed = perturbed,
      .model_error = model_error};
  return kind;
}

}  // namespace pendular::diagnosis
