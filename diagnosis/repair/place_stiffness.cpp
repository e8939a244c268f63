#include "diagnosis/repair/place_stiffness.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/eigensystem.h"
#include "base/parallel.h"
#include "dem_core/linear/joints.h"
#include "dem_core/linear/stiffness_sensitivity.h"
#include "diagnosis/thresholds.h"
#include "packing/bridges.h"

namespace pendular::diagnosis {
namespace {

constexpr double kSpacing = 1.6, kShare = 0.7, kCorrelation = 1.5;  // of regions, mean diameters
constexpr std::size_t kMostRegions = 200;
constexpr double kNeighbours =
    0.064;                           // gap of beads whose parting weighs scans against simulation, diameters
constexpr double kTolerance = 1e-4;  // of linear solves
constexpr double kDof = 4.0;         // of the t distribution of a bead's difference
constexpr int kRounds = 6;           // of its weights
constexpr double kSizes[] = {0.05, 0.1, 0.2, 0.4, 0.8, 1.6};  // of changes, before they are seen

/// Beads far from each other: each next one is the farthest from those before.
std::vector<std::size_t> centres_of_regions(const MovedBeads& beads) {
  std::vector<std::size_t> centres = {0};
  std::vector<double> away(beads.size(), std::numeric_limits<double>::infinity());
  while (centres.size() < kMostRegions) {
    for (std::size_t k = 0; k < away.size(); ++k)
      away[k] = std::min(away[k], (beads.rest[k] - beads.rest[centres.back()]).norm());
    const auto farthest = std::max_element(away.begin(), away.end());
    if (*farthest < kSpacing * beads.diameter) break;
    centres.push_back(static_cast<std::size_t>(farthest - away.begin()));
  }
  return centres;
}

/// Shares of each place in each region: Gaussians that sum to one. Wider where regions are farther apart.
Eigen::MatrixXd shares_of(const std::vector<Vec3>& places, const MovedBeads& beads,
                          const std::vector<std::size_t>& centres) {
  double apart = 0.0;
  for (std::size_t a : centres) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t b : centres)
      if (a != b) nearest = std::min(nearest, (beads.rest[a] - beads.rest[b]).norm());
    apart += nearest / static_cast<double>(centres.size());
  }
  const double width = kShare * std::max(1.0, apart / (kSpacing * beads.diameter)) * beads.diameter;
  Eigen::MatrixXd shares(static_cast<Eigen::Index>(places.size()), static_cast<Eigen::Index>(centres.size()));
  for (Eigen::Index k = 0; k < shares.rows(); ++k) {
    for (Eigen::Index r = 0; r < shares.cols(); ++r)
      shares(k, r) = -0.5 *
                     (places[static_cast<std::size_t>(k)] - beads.rest[centres[static_cast<std::size_t>(r)]])
                         .squaredNorm() /
                     (width * width);
    shares.row(k) = (shares.row(k).array() - shares.row(k).maxCoeff()).exp();
    shares.row(k) /= shares.row(k).sum();
  }
  return shares;
}

Eigen::MatrixXd prior_of(const MovedBeads& beads, const std::vector<std::size_t>& centres) {
  const auto count = static_cast<Eigen::Index>(centres.size());
  Eigen::MatrixXd prior(count, count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b)
      prior(a, b) = std::exp(-0.5 *
                             (beads.rest[centres[static_cast<std::size_t>(a)]] -
                              beads.rest[centres[static_cast<std::size_t>(b)]])
                                 .squaredNorm() /
                             std::pow(kCorrelation * beads.diameter, 2));
  prior.diagonal().array() += 1e-3;
  return prior;
}

/// The share of the measured difference that is not noise, by how neighbours part in it.
double weight_of_scans(const MovedBeads& beads, const std::vector<Vec3>& difference) {
  std::vector<Bead> points(beads.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    points[k].centre = beads.rest[k], points[k].diameter = beads.diameter;
  double square = 0.0, count = 0.0;
  for (const auto& pair : candidate_bridges(points, kNeighbours * beads.diameter)) {
    square += (difference[static_cast<std::size_t>(pair.i)] - difference[static_cast<std::size_t>(pair.j)])
                  .squaredNorm();
    count += 3.0;
  }
  const double noise = 2.0 * beads.sigma * beads.sigma * count;
  return square > noise ? 1.0 - noise / square : 0.0;
}

/// Displacements of all nodes in the frame of the simulation, for closures. Beads that were not followed move
/// as the nearest one does.
dem_core::NodeVector seen_motion(const dem_core::Simulation& specimen, double travel,
                                 const std::vector<int>& bead, const std::vector<Vec3>& moved,
                                 const MovedBeads& beads) {
  dem_core::NodeVector x =
      dem_core::NodeVector::Zero(6 * static_cast<Eigen::Index>(specimen.beads.size() + 2));
  std::vector<int> source(specimen.beads.size(), -1);
  for (std::size_t k = 0; k < bead.size(); ++k)
    source[static_cast<std::size_t>(bead[k])] = static_cast<int>(k);
  for (std::size_t n = 0; n < source.size(); ++n) {
    std::size_t from = static_cast<std::size_t>(std::max(source[n], 0));
    if (source[n] < 0)
      for (std::size_t k = 0; k < bead.size(); ++k)
        if ((beads.rest[k] - specimen.beads.position[n]).norm() <
            (beads.rest[from] - specimen.beads.position[n]).norm())
          from = k;
    x.segment<3>(6 * static_cast<Eigen::Index>(n)) = moved[from];
  }
  x[6 * static_cast<Eigen::Index>(source.size()) + 2] = travel;
  return x;
}

/// Takes shift, rotation and change of scale off the columns.
void remove_similarity(const std::vector<Vec3>& rest, double length, Eigen::MatrixXd& columns) {
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(columns.rows(), 7);
  for (std::size_t k = 0; k < rest.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(3 * k);
      modes(row + axis, axis) = 1.0;
      modes.block<3, 1>(row, 3 + axis) = Vec3::Unit(axis).cross(rest[k]) / length;
      modes(row + axis, 6) = rest[k][axis] / length;
    }
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(modes).householderQ() *
                            Eigen::MatrixXd::Identity(columns.rows(), 7);
  columns -= q * (q.transpose() * columns);
}

Eigen::VectorXd rows_of(const std::vector<Vec3>& field) {
  Eigen::VectorXd rows(static_cast<Eigen::Index>(3 * field.size()));
  for (std::size_t k = 0; k < field.size(); ++k) rows.segment<3>(static_cast<Eigen::Index>(3 * k)) = field[k];
  return rows;
}

/// The most probable numbers at one size of the prior, along the axes in which they are independent.
struct SizedFit {
  Eigen::VectorXd numbers;
  double scale = 1.0;  ///< of the variance
  double evidence = -std::numeric_limits<double>::infinity();
};

/// `information`: that of the data on each number, at the stated variance; `load`: what they say of it times
/// that; `square`: the weighted square of the difference, of so many rows.
SizedFit sized_fit(const Eigen::ArrayXd& information, const Eigen::ArrayXd& load, double square, double rows,
                   double size) {
  const double precision = 1.0 / (size * size);
  const auto misfit = [&](const Eigen::ArrayXd& x) {
    return square - 2.0 * (x * load).sum() + (x.square() * information).sum();
  };
  const Eigen::ArrayXd whole = information + precision;
  const double dof = rows - (information / whole).sum();
  SizedFit fit;
  fit.scale = std::max(1.0, misfit(load / whole) / dof);
  const Eigen::ArrayXd scaled = information / fit.scale + precision;
  const Eigen::ArrayXd x = load / fit.scale / scaled;
  fit.evidence = -0.5 * (misfit(x) / fit.scale + precision * x.square().sum() + rows * std::log(fit.scale) +
                         (scaled / precision).log().sum());
  fit.numbers = x;
  return fit;
}

/// Standard errors of the beads' changes.
Eigen::VectorXd errors_of(const Eigen::MatrixXd& shares, const RegionFit& fit) {
  return (shares * fit.covariance).cwiseProduct(shares).rowwise().sum().cwiseSqrt();
}

}  // namespace

Regions regions_of(const Eigen::MatrixXd& sensitivity, const Eigen::MatrixXd& prior) {
  Regions regions;
  regions.root = prior.llt().matrixL();
  regions.sensitivity = sensitivity * regions.root;
  return regions;
}

RegionFit fit_regions(const Regions& regions, const Eigen::VectorXd& variance,
                      const Eigen::VectorXd& difference) {
  const Eigen::Index rows = difference.size(), beads = rows / 3, count = regions.sensitivity.cols();
  Eigen::VectorXd weight = variance.cwiseInverse();
  Eigen::MatrixXd axes;
  Eigen::ArrayXd information;
  SizedFit best;
  double size = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixXd weighted = weight.cwiseSqrt().asDiagonal() * regions.sensitivity;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(count, count);
    all.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
    const auto [values, vectors] = eigensystem(all);
    axes = vectors, information = values.array().max(0.0);
    const Eigen::ArrayXd load =
        axes.transpose() * (regions.sensitivity.transpose() * weight.cwiseProduct(difference));
    const double square = difference.cwiseAbs2().dot(weight);
    best = {};
    for (const double tried : kSizes)
      if (SizedFit fit = sized_fit(information, load, square, static_cast<double>(rows), tried);
          fit.evidence > best.evidence)
        best = std::move(fit), size = tried;
    const Eigen::VectorXd left = difference - regions.sensitivity * (axes * best.numbers);
    for (Eigen::Index k = 0; k < beads; ++k) {
      double of_bead = 0.0;
      for (Eigen::Index row = 3 * k; row < 3 * k + 3; ++row)
        of_bead += left[row] * left[row] / (variance[row] * best.scale);
      weight.segment<3>(3 * k) = (kDof + 3.0) / (kDof + of_bead) * variance.segment<3>(3 * k).cwiseInverse();
    }
  }
  const Eigen::ArrayXd scaled = information / best.scale;
  const Eigen::MatrixXd spread =
      regions.root * axes * (scaled.sqrt() / (scaled + 1.0 / (size * size))).matrix().asDiagonal();
  return {regions.root * (axes * best.numbers), spread * spread.transpose(), std::sqrt(best.scale)};
}

PlaceStiffness place_stiffness(const dem_core::Simulation& specimen, double strain,
                               const std::vector<int>& bead, const std::vector<Vec3>& simulated,
                               const MovedBeads& beads) {
  const auto mean = mean_member(beads);
  std::vector<Vec3> difference, moved;
  for (std::size_t k = 0; k < mean.size(); ++k) difference.push_back(beads.measured[k] - mean[k]);
  const double weight = weight_of_scans(beads, difference), travel = strain * specimen.initial_height;
  for (std::size_t k = 0; k < mean.size(); ++k) moved.push_back(simulated[k] + weight * difference[k]);

  dem_core::Simulation listed = specimen;
  dem_core::list_pairs(listed, (0.025 + 0.5 * strain) * listed.beads.mean_diameter());
  const auto joints = dem_core::joints_of(listed, travel);
  dem_core::NodeVector x = seen_motion(listed, travel, bead, moved, beads);
  const dem_core::SpringNetwork network = dem_core::network_of(
      listed, joints, dem_core::closures_at(dem_core::nodes_of(listed), joints, x), true);
  solve(network, network.pushes(), kTolerance, x);

  const auto centres = centres_of_regions(beads);
  const Eigen::MatrixXd at_nodes = shares_of(listed.beads.position, beads, centres);
  Eigen::MatrixXd sensitivity(static_cast<Eigen::Index>(3 * bead.size()), at_nodes.cols());
  for_blocks(centres.size(), 1, [&](std::size_t region, std::size_t) {
    const auto r = static_cast<Eigen::Index>(region);
    std::vector<double> of_spring;
    for (const auto& spring : network.springs())
      of_spring.push_back(spring.j < network.free_nodes()
                              ? 0.5 * (at_nodes(spring.i, r) + at_nodes(spring.j, r))
                              : at_nodes(spring.i, r));
    const dem_core::NodeVector change = dem_core::stiffness_sensitivity(network, x, of_spring, kTolerance);
    for (std::size_t k = 0; k < bead.size(); ++k)
      sensitivity.block<3, 1>(static_cast<Eigen::Index>(3 * k), r) = change.segment<3>(6 * bead[k]);
  });
  remove_similarity(beads.rest, beads.diameter, sensitivity);

  Eigen::VectorXd variance(sensitivity.rows());
  const auto of_members = member_variance(beads);
  for (std::size_t k = 0; k < bead.size(); ++k)
    variance.segment<3>(static_cast<Eigen::Index>(3 * k))
        .setConstant(beads.sigma * beads.sigma + of_members[k]);
  const Eigen::MatrixXd shares = shares_of(beads.rest, beads, centres);
  const Regions regions = regions_of(sensitivity, prior_of(beads, centres));
  const RegionFit fit = fit_regions(regions, variance, rows_of(difference));
  // Members scatter alike from bead to bead, which single beads' variances do not say: what members
  // themselves come to, taken for the experiment, scales the errors.
  const auto nulls = null_differences(beads, 1);
  std::vector<double> maxima(nulls.size()), squares(nulls.size());
  for_blocks(nulls.size(), 1, [&](std::size_t k, std::size_t) {
    const RegionFit of_null = fit_regions(regions, variance, rows_of(nulls[k]));
    const Eigen::VectorXd z = (shares * of_null.change).cwiseQuotient(errors_of(shares, of_null));
    maxima[k] = z.cwiseAbs().maxCoeff();
    squares[k] = z.squaredNorm() / static_cast<double>(z.size());
  });
  double square = 0.0;
  for (const double one : squares) square += one;
  const double scale = std::max(1.0, std::sqrt(square / static_cast<double>(maxima.size())));

  PlaceStiffness found;
  found.regions = static_cast<int>(centres.size());
  found.left = fit.left;
  found.threshold = exceeded_by(maxima, kThresholds.false_places) / scale;
  const Eigen::VectorXd change = shares * fit.change;
  const Eigen::VectorXd sigma = scale * errors_of(shares, fit);
  found.change.assign(change.data(), change.data() + change.size());
  found.sigma.assign(sigma.data(), sigma.data() + sigma.size());
  return found;
}

}  // namespace pendular::diagnosis
