#include "diagnosis/bank/field_readings.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/parallel.h"
#include "base/random.h"
#include "diagnosis/kinds/kind.h"
#include "diagnosis/thresholds.h"
#include "effects/compress.h"
#include "effects/list.h"
#include "packing/bridges.h"
#include "packing/tables.h"

namespace pendular::diagnosis {
namespace {

constexpr unsigned long kSeedOfRuns = 1000;  // of their noise
constexpr std::uint64_t kSeedOfErrors = 0x706c61636573;
constexpr int kHeldBy = 3;  // bonds: on two, a bead turns about the line through them without resistance

/// Beads that at least three pairs hold, of which the same is true: how the others move, damping decides.
std::map<std::int64_t, Bead> held_beads(const std::vector<Bead>& beads, double cutoff) {
  const auto pairs = candidate_bridges(beads, cutoff);
  std::vector<char> held(beads.size(), true);
  for (bool changed = true; changed;) {
    std::vector<int> count(beads.size(), 0);
    for (const auto& pair : pairs) {
      const auto i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
      if (held[i] && held[j]) ++count[i], ++count[j];
    }
    changed = false;
    for (std::size_t k = 0; k < beads.size(); ++k)
      if (held[k] && count[k] < kHeldBy) held[k] = false, changed = true;
  }
  std::map<std::int64_t, Bead> found;
  for (std::size_t k = 0; k < beads.size(); ++k)
    if (held[k]) found[beads[k].id] = beads[k];
  return found;
}

/// The rows of beads that are held.
Columns rows_of(const std::map<std::int64_t, Bead>& held, const Columns& columns) {
  Columns kept;
  for (std::size_t k = 0; k < columns.at("bead_id").size(); ++k)
    if (held.contains(static_cast<std::int64_t>(columns.at("bead_id")[k])))
      for (const auto& [name, values] : columns) kept[name].push_back(values[k]);
  return kept;
}

double cutoff_of(const Sample& sample) {
  return sample.bridges.cutoff * sample.beads.diameter;
}

/// The beads of an observation's scans, one after the other, in the order of its field.
std::vector<FollowedBeads> followed_in(const Sample& sample, const std::map<std::int64_t, Bead>& by_id,
                                       const Observation& observation) {
  const auto& strains = observation.column("strain");
  std::vector<FollowedBeads> scans;
  for (const double strain : std::set<double>(strains.begin(), strains.end())) {
    FollowedBeads followed;
    followed.strain = strain;
    followed.cutoff = cutoff_of(sample);
    double stated = 0.0;
    for (std::size_t k = 0; k < strains.size(); ++k) {
      if (strains[k] != strain) continue;
      const Bead& bead = by_id.at(static_cast<std::int64_t>(observation.column("bead_id")[k]));
      followed.beads.push_back(bead);
      stated +=
          observation.has("sigma_um") ? observation.column("sigma_um")[k] : M_SQRT2 * 1e6 * bead.sigma_centre;
    }
    followed.sigma_um = stated / static_cast<double>(followed.beads.size());
    if (!(followed.sigma_um > 0.0))
      followed.sigma_um = kThresholds.unstated_sigma * 1e6 * sample.beads.diameter;
    scans.push_back(std::move(followed));
  }
  return scans;
}

/// One scan's part of a field.
Eigen::VectorXd part_of(const Eigen::VectorXd& field, const std::vector<FollowedBeads>& scans,
                        std::size_t scan) {
  Eigen::Index first = 0;
  for (std::size_t s = 0; s < scan; ++s) first += static_cast<Eigen::Index>(3 * scans[s].beads.size());
  return field.segment(first, static_cast<Eigen::Index>(3 * scans[scan].beads.size()));
}

Eigen::VectorXd joined(const std::vector<Eigen::VectorXd>& parts) {
  Eigen::Index size = 0;
  for (const auto& part : parts) size += part.size();
  Eigen::VectorXd all(size);
  size = 0;
  for (const auto& part : parts) all.segment(size, part.size()) = part, size += part.size();
  return all;
}

/// Mean square of how far neighbours part along an axis, µm², in one scan's part of a field.
double parting(const std::vector<Bridge>& pairs, const Eigen::VectorXd& part) {
  double sum = 0.0;
  for (const auto& pair : pairs)
    sum += (part.segment<3>(3 * pair.j) - part.segment<3>(3 * pair.i)).squaredNorm();
  return pairs.empty() ? 0.0 : sum / (3.0 * static_cast<double>(pairs.size()));
}

/// Standard error of a component of a displacement, beyond the stated one, that the measured ones may have in
/// each scan, µm: that of single beads, by what neighbours part more than as believed.
std::vector<double> unstated_errors(const FieldBank& bank, const std::vector<DesignPoint>& points) {
  std::vector<double> found;
  for (std::size_t s = 0; s < bank.scans.size(); ++s) {
    const auto pairs = candidate_bridges(bank.scans[s].beads, bank.scans[s].cutoff);
    double believed = 0.0, count = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (points[k].id.empty() && bank.of_runs[k])
        believed += parting(pairs, part_of(*bank.of_runs[k], bank.scans, s)), count += 1.0;
    const double more = parting(pairs, part_of(bank.measured, bank.scans, s)) - believed / count;
    found.push_back(std::sqrt(std::max(0.0, 0.5 * more - std::pow(bank.scans[s].sigma_um, 2))));
  }
  return found;
}

/// What effects on bead tables leave unstated of the error of a centre along an axis, µm.
double error_of_places(const Changes& changes) {
  Sample sample;
  for (const auto& [id, theta] : changes)
    if (effects::known_effect(id)) sample.effects[id] = theta;
  return 1e6 * effects::actual_beads({Bead{}}, sample).front().sigma_centre;
}

/// Displacements are differences of two places: where an effect makes those uncertain, they have the error of
/// both, that at rest in every scan. Errors that are the same in both cancel: there are no larger ones than
/// the measured motion shows.
void add_errors_of_places(const std::vector<DesignPoint>& points, FieldBank& bank) {
  const auto unstated = unstated_errors(bank, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double error = error_of_places(points[k].changes);
    if (error == 0.0 || !bank.of_runs[k]) continue;
    const std::uint64_t draws = random_bits(kSeedOfErrors, points[k].seed);
    Eigen::Index row = 0;
    for (std::size_t s = 0; s < bank.scans.size(); ++s)
      for (const Bead& bead : bank.scans[s].beads)
        for (std::uint64_t axis = 0; axis < 3; ++axis, ++row) {
          const std::uint64_t place = 3 * static_cast<std::uint64_t>(bead.id) + axis;
          (*bank.of_runs[k])[row] +=
              std::min(error, M_SQRT1_2 * unstated[s]) *
              (random_normal(random_bits(draws, s + 1), place) - random_normal(random_bits(draws, 0), place));
        }
  }
}

}  // namespace

std::optional<FieldBank> field_bank(const Experiment& experiment, const BankPlan& plan, std::size_t index,
                                    const std::vector<SimulatedTests>& tests) {
  Observation observation = experiment.observations[index];
  const auto& field = observation.kind->field;
  if (!field || observation.beads.empty()) return std::nullopt;
  constexpr double um = 1e6;
  const Sample sample = experiment.sample_of(observation);
  const auto held = held_beads(read_beads(observation.beads), cutoff_of(sample));
  observation.columns = rows_of(held, observation.columns);
  if (observation.columns.empty()) return std::nullopt;
  auto scans = followed_in(sample, held, observation);
  for (const auto& scan : scans)
    if (scan.beads.size() < observation.kind->least_rows) return std::nullopt;
  FieldBank bank{observation.name, std::move(scans), um * field(observation, observation.columns), {}};
  bank.of_runs.resize(plan.points.size());
  for_blocks(plan.points.size(), 1, [&](std::size_t k, std::size_t) {
    if (const auto columns =
            simulated_columns(experiment, plan.conditions, index, tests[k], plan.points[k].changes))
      bank.of_runs[k] = um * field(observation, rows_of(held, *columns));
  });
  bool baseline = false;
  for (std::size_t k = 0; k < plan.points.size(); ++k)
    baseline = baseline || (bank.of_runs[k] && plan.points[k].id.empty());
  if (!baseline) return std::nullopt;
  add_errors_of_places(plan.points, bank);
  return bank;
}

FieldReader::FieldReader(const FieldBank& bank, const std::vector<DesignPoint>& points, int but) : but_(but) {
  for (std::size_t s = 0; s < bank.scans.size(); ++s) {
    std::vector<BankField> learnt;
    for (std::size_t k = 0; k < bank.of_runs.size(); ++k)
      if (bank.of_runs[k] && points[k].member != but && !points[k].at_fit)
        learnt.push_back(
            {points[k].member, points[k].id, points[k].theta, part_of(*bank.of_runs[k], bank.scans, s)});
    statistics_.emplace_back(bank.scans[s], learnt);
  }
}

std::vector<Feature> FieldReader::measured(const FieldBank& bank) const {
  std::vector<Feature> found;
  for (std::size_t s = 0; s < statistics_.size(); ++s) {
    const FieldStatistics& read = statistics_[s];
    const Eigen::VectorXd values = read(part_of(bank.measured, bank.scans, s));
    for (std::size_t n = 0; n < read.size(); ++n)
      found.push_back({bank.observation,
                       fmt::format("{}_at_{:.2f}_percent", read.names()[n], 100.0 * read.strain()),
                       Scale::network, false, values[static_cast<Eigen::Index>(n)], 0.0, read.strain()});
  }
  return found;
}

Eigen::VectorXd FieldReader::noise(unsigned long seed) const {
  std::vector<Eigen::VectorXd> parts;
  for (const auto& statistics : statistics_) parts.push_back(statistics.noise(seed));
  return joined(parts);
}

Eigen::VectorXd FieldReader::read(const Eigen::VectorXd& field) const {
  std::vector<Eigen::VectorXd> parts;
  Eigen::Index first = 0;
  for (const auto& statistics : statistics_) {
    const Eigen::Index size = statistics.reference().size();
    parts.push_back(statistics(field.segment(first, size)));
    first += size;
  }
  return joined(parts);
}

std::vector<Eigen::VectorXd> FieldReader::of_runs(const FieldBank& bank,
                                                  const std::vector<DesignPoint>& points) const {
  std::size_t size = 0;
  for (const auto& statistics : statistics_) size += statistics.size();
  std::map<int, Eigen::VectorXd> noises;
  for (const auto& point : points)
    if (!noises.contains(point.member))
      noises[point.member] = noise(kSeedOfRuns + static_cast<unsigned long>(point.member));
  const Eigen::VectorXd unknown = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(size), std::nan(""));
  std::vector<Eigen::VectorXd> found(bank.of_runs.size());
  for_blocks(found.size(), 1, [&](std::size_t k, std::size_t) {
    const bool known = bank.of_runs[k] && points[k].member != but_;
    found[k] = known ? read(*bank.of_runs[k] + noises.at(points[k].member)) : unknown;
  });
  return found;
}

Eigen::VectorXd FieldReader::by_noise(const FieldBank& bank, const std::vector<DesignPoint>& points) const {
  Eigen::VectorXd sum;
  double count = 0.0;
  for (std::size_t k = 0; k < bank.of_runs.size(); ++k) {
    if (!bank.of_runs[k] || !points[k].id.empty() || points[k].member == but_) continue;
    const Eigen::VectorXd drawn = noise(static_cast<unsigned long>(points[k].member));
    const Eigen::VectorXd more = read(*bank.of_runs[k] + (1.0 + kThresholds.stated_error) * drawn) -
                                 read(*bank.of_runs[k] + (1.0 - kThresholds.stated_error) * drawn);
    sum = count > 0.0 ? Eigen::VectorXd(sum + more) : more;
    count += 2.0;
  }
  return sum / count;
}

Eigen::MatrixXd field_model_error(const std::vector<Eigen::VectorXd>& baselines) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(baselines.front().size()), square = mean;
  for (const auto& one : baselines) mean += one / static_cast<double>(baselines.size());
  for (const auto& one : baselines)
    square += (one - mean).cwiseAbs2() / static_cast<double>(baselines.size());
  return (kThresholds.field_share * kThresholds.field_share * square.array() +
          kThresholds.field_floor * kThresholds.field_floor)
      .matrix()
      .asDiagonal();
}

}  // namespace pendular::diagnosis
