#include "diagnosis/field_readings.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "diagnosis/kinds/kind.h"
#include "packing/tables.h"

namespace pendular::diagnosis {
namespace {

constexpr double kStatedError = 0.2;      // of stated standard errors
constexpr double kModelShare = 0.15;      // of what members scatter by
constexpr double kModelFloor = 0.02;      // of a reading
constexpr double kUnstatedSigma = 1e-3;   // of displacements, over the beads' diameter, where nothing is stated

/// The beads of an observation's scans, one after the other, in the order of its field.
std::vector<FollowedBeads> followed_in(const Experiment& experiment, const Observation& observation) {
  const Sample sample = experiment.sample_of(observation);
  std::map<std::int64_t, Bead> by_id;
  for (const auto& bead : read_beads(observation.beads)) by_id[bead.id] = bead;
  const auto& strains = observation.column("strain");
  std::vector<FollowedBeads> scans;
  for (const double strain : std::set<double>(strains.begin(), strains.end())) {
    FollowedBeads followed;
    followed.strain = strain;
    followed.cutoff = sample.bridges.cutoff * sample.beads.diameter;
    double stated = 0.0;
    for (std::size_t k = 0; k < strains.size(); ++k) {
      if (strains[k] != strain) continue;
      const Bead& bead = by_id.at(static_cast<std::int64_t>(observation.column("bead_id")[k]));
      followed.beads.push_back(bead);
      stated += observation.has("sigma_um") ? observation.column("sigma_um")[k] : M_SQRT2 * 1e6 * bead.sigma_centre;
    }
    followed.sigma_um = stated / static_cast<double>(followed.beads.size());
    if (!(followed.sigma_um > 0.0)) followed.sigma_um = kUnstatedSigma * 1e6 * sample.beads.diameter;
    scans.push_back(std::move(followed));
  }
  return scans;
}

/// One scan's part of a field.
struct Part {
  Eigen::Index first, size;
};

std::vector<Part> parts_of(const std::vector<FollowedBeads>& scans) {
  std::vector<Part> parts;
  Eigen::Index at = 0;
  for (const auto& scan : scans) {
    const auto size = static_cast<Eigen::Index>(3 * scan.beads.size());
    parts.push_back({at, size});
    at += size;
  }
  return parts;
}

Eigen::VectorXd joined(const std::vector<Eigen::VectorXd>& parts) {
  Eigen::Index size = 0;
  for (const auto& part : parts) size += part.size();
  Eigen::VectorXd all(size);
  size = 0;
  for (const auto& part : parts) all.segment(size, part.size()) = part, size += part.size();
  return all;
}

}  // namespace

std::optional<FieldReadings> field_readings(const Experiment& experiment, const BankPlan& plan,
                                            std::size_t index, const std::vector<SimulatedTests>& tests) {
  const Observation& observation = experiment.observations[index];
  if (!observation.kind->field || observation.beads.empty()) return std::nullopt;
  const auto scans = followed_in(experiment, observation);
  const auto parts = parts_of(scans);
  const double um = 1e6;

  std::vector<std::optional<Eigen::VectorXd>> fields;
  bool baseline = false;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const auto columns =
        simulated_columns(experiment, plan.conditions, index, tests[k], plan.points[k].changes);
    fields.emplace_back(columns ? std::optional(Eigen::VectorXd(um * observation.kind->field(observation, *columns)))
                                : std::nullopt);
    baseline = baseline || (columns && plan.points[k].id.empty());
  }
  if (!baseline) return std::nullopt;
  const Eigen::VectorXd seen = um * observation.kind->field(observation, observation.columns);

  FieldReadings readings;
  std::vector<FieldStatistics> statistics;
  std::vector<Eigen::VectorXd> of_seen, by_noise;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    std::vector<BankField> bank;
    for (std::size_t k = 0; k < fields.size(); ++k)
      if (fields[k])
        bank.push_back({plan.points[k].member, plan.points[k].id, plan.points[k].theta,
                        fields[k]->segment(parts[s].first, parts[s].size)});
    const FieldStatistics& read = statistics.emplace_back(scans[s], bank);
    of_seen.push_back(read(seen.segment(parts[s].first, parts[s].size)));
    for (std::size_t n = 0; n < read.size(); ++n)
      readings.observed.push_back({observation.name,
                                   fmt::format("{}_at_{:.2f}_percent", read.names()[n], 100.0 * read.strain()),
                                   Scale::network, false, of_seen.back()[static_cast<Eigen::Index>(n)], 0.0,
                                   read.strain()});
    Eigen::VectorXd more = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(read.size()));
    double count = 0.0;
    for (const auto& one : bank) {
      if (!one.id.empty()) continue;
      const auto seed = static_cast<unsigned long>(one.member);
      more += read(one.values + read.noise(seed, 1.0 + kStatedError)) -
              read(one.values + read.noise(seed, 1.0 - kStatedError));
      count += 2.0;
    }
    by_noise.push_back(more / count);
  }
  readings.by_noise = joined(by_noise);

  const auto size = readings.by_noise.size();
  std::vector<Eigen::VectorXd> baselines;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (!fields[k]) {
      readings.of_runs.push_back(Eigen::VectorXd::Constant(size, std::nan("")));
      continue;
    }
    std::vector<Eigen::VectorXd> of_run;
    for (std::size_t s = 0; s < scans.size(); ++s)
      of_run.push_back(statistics[s](fields[k]->segment(parts[s].first, parts[s].size) +
                                     statistics[s].noise(1000 + static_cast<unsigned long>(k))));
    readings.of_runs.push_back(joined(of_run));
    if (plan.points[k].id.empty()) baselines.push_back(readings.of_runs.back());
  }
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(size), square = mean;
  for (const auto& one : baselines) mean += one / static_cast<double>(baselines.size());
  for (const auto& one : baselines) square += (one - mean).cwiseAbs2() / static_cast<double>(baselines.size());
  readings.model = (kModelShare * kModelShare * square.array() + kModelFloor * kModelFloor).matrix().asDiagonal();
  return readings;
}

}  // namespace pendular::diagnosis
