#include "diagnosis/bank/emulator.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/eigensystem.h"
#include "base/quantile.h"
#include "diagnosis/bank/mean_row.h"
#include "diagnosis/thresholds.h"

namespace pendular::diagnosis {
namespace {

constexpr int kDrawnSteps = 40;  // up to 10⁵ times the scatter
constexpr int kDegree = 2, kExactDegree = 4;
constexpr std::size_t kLevelsOfEarly = 4, kRunsOfEarly = 6;  // that tell what comes early from a quadratic
constexpr double kGrowths[] = {0.5, 1.0, 1.5, 2.0};
constexpr double kOfMedian = 1.4826;

/// Runs of one id, less the baselines of their members.
struct Group {
  std::string id;
  bool draws = false, exact = false, below = false;
  std::vector<double> theta;
  std::vector<Eigen::VectorXd> change;

  double scale() const {
    double most = 0.0;
    for (double one : theta) most = std::max(most, std::fabs(one));
    return most;
  }
  std::size_t levels() const { return std::set<double>(theta.begin(), theta.end()).size(); }
  int degree() const { return levels() < 2 ? 1 : exact && levels() > kExactDegree ? kExactDegree : kDegree; }
  bool comes_early() const { return !exact && levels() >= kLevelsOfEarly && theta.size() >= kRunsOfEarly; }
  int parameters() const { return degree() + (comes_early() ? 1 : 0); }
  double share(std::size_t run) const { return std::fabs(theta[run]) / scale(); }
};

void take_baselines(const std::vector<DesignRun>& runs, Eigen::Index features, Responses& responses) {
  std::map<int, std::vector<const DesignRun*>> baselines;
  for (const auto& run : runs)
    if (run.id.empty()) baselines[run.member].push_back(&run);
  responses.offsets =
      Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(baselines.size()), features, std::nan(""));
  for (const auto& [member, of_it] : baselines) {
    responses.offsets.row(static_cast<Eigen::Index>(responses.members.size())) =
        of_it.front()->values.transpose();
    responses.members.push_back(member);
  }
  std::vector<Eigen::VectorXd> rows;
  for (const auto& row : responses.offsets.rowwise()) rows.push_back(row.transpose());
  responses.mean = mean_row(rows, features);
}

std::vector<Group> groups_of(const std::vector<DesignRun>& runs, const Responses& responses) {
  std::vector<Group> groups;
  for (const auto& run : runs) {
    if (run.id.empty()) continue;
    const bool below = run.sided && run.theta < 0.0;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group& g) { return g.id == run.id && g.below == below; });
    if (group == groups.end())
      group = groups.insert(groups.end(), {run.id, run.draws, run.exact, below, {}, {}});
    group->theta.push_back(run.theta);
    group->change.push_back(run.values - responses.baseline(run.member));
  }
  return groups;
}

/// Mean products of rows, over those that are finite in both columns.
Eigen::MatrixXd pairwise(const Eigen::MatrixXd& rows, double dof_lost) {
  const Eigen::MatrixXd shown = rows.array().isFinite().cast<double>();
  const Eigen::MatrixXd values = rows.array().isFinite().select(rows, 0.0);
  const Eigen::MatrixXd counts = shown.transpose() * shown;
  return (values.transpose() * values).array() / (counts.array() - dof_lost).max(1.0);
}

/// Residuals of a fit: over the square root of the room that the fit leaves each, so that they have the
/// scatter's variance; and over that room, which is by how much a run is missed by a fit without it.
struct Residuals {
  Eigen::MatrixXd scaled, missed;
};

Response fit_group(const Group& group, Eigen::Index features, Residuals& left) {
  const auto runs = static_cast<Eigen::Index>(group.theta.size());
  const int degree = group.degree();
  const double scale = group.scale();
  Eigen::MatrixXd matrix(runs, group.parameters());
  for (Eigen::Index r = 0; r < runs; ++r) {
    const auto run = static_cast<std::size_t>(r);
    for (int n = 0; n < degree; ++n) matrix(r, n) = std::pow(group.theta[run] / scale, n + 1);
    if (group.comes_early()) matrix(r, degree) = std::log1p(group.share(run) / kThresholds.early_at);
  }
  Response response;
  response.powers.assign(static_cast<std::size_t>(degree), Eigen::VectorXd::Zero(features));
  if (group.comes_early())
    response.early = Eigen::VectorXd::Zero(features), response.early_at = kThresholds.early_at * scale;
  left.scaled = Eigen::MatrixXd::Constant(runs, features, std::nan(""));
  left.missed = left.scaled;
  for (Eigen::Index f = 0; f < features; ++f) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index r = 0; r < runs; ++r)
      if (std::isfinite(group.change[static_cast<std::size_t>(r)][f])) rows.push_back(r);
    if (rows.empty()) continue;
    Eigen::VectorXd values(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r)
      values[static_cast<Eigen::Index>(r)] = group.change[static_cast<std::size_t>(rows[r])][f];
    const Eigen::MatrixXd shown = matrix(rows, Eigen::all);
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(shown);
    const Eigen::VectorXd found = solver.solve(values);
    const Eigen::MatrixXd inverse = solver.pseudoInverse();
    for (int n = 0; n < degree; ++n)
      response.powers[static_cast<std::size_t>(n)][f] = found[n] / std::pow(scale, n + 1);
    if (group.comes_early()) response.early[f] = found[degree];
    const Eigen::VectorXd residual = values - shown * found;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto at = static_cast<Eigen::Index>(r);
      const double room = std::max(kThresholds.least_room, 1.0 - shown.row(at).dot(inverse.col(at)));
      left.scaled(rows[r], f) = residual[at] / std::sqrt(room);
      left.missed(rows[r], f) = residual[at] / room;
    }
  }
  return response;
}

/// No residual beyond some median deviations of its column.
void draw_in_outliers(Eigen::MatrixXd& left) {
  for (Eigen::Index f = 0; f < left.cols(); ++f) {
    std::vector<double> sizes;
    for (const double one : left.col(f))
      if (std::isfinite(one)) sizes.push_back(std::fabs(one));
    if (sizes.empty()) continue;
    const double most = kThresholds.outlier * kOfMedian * median(sizes);
    for (double& one : left.col(f))
      if (std::isfinite(one)) one = std::clamp(one, -most, most);
  }
}

Eigen::MatrixXd stacked(const std::vector<Eigen::MatrixXd>& blocks, Eigen::Index columns) {
  Eigen::Index rows = 0;
  for (const auto& block : blocks) rows += block.rows();
  Eigen::MatrixXd all(rows, columns);
  rows = 0;
  for (const auto& block : blocks) all.middleRows(rows, block.rows()) = block, rows += block.rows();
  return all;
}

Eigen::MatrixXd shrunk(const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd drawn = (1.0 - kThresholds.to_diagonal) * covariance;
  drawn.diagonal() = covariance.diagonal();
  return positive_part(drawn);
}

/// The power of θ with which squares beyond the scatter grow: the likeliest of some, for the mean squares of
/// runs, in units of the scatter.
double growth_of(const Group& group, const Eigen::MatrixXd& missed, const Eigen::MatrixXd& scatter) {
  if (!group.comes_early()) return 2.0;
  std::vector<double> squares;
  for (const auto& row : missed.rowwise()) {
    const Eigen::ArrayXd relative = row.transpose().array().square() / scatter.diagonal().array().max(1e-12);
    const auto shown = relative.isFinite();
    squares.push_back(shown.select(relative, 0.0).sum() /
                      std::max<double>(1.0, static_cast<double>(shown.count())));
  }
  double best = -std::numeric_limits<double>::infinity(), found = 2.0;
  for (const double growth : kGrowths)
    for (int step = 0; step < kDrawnSteps; ++step) {
      const double drawn = 0.01 * std::pow(1.5, step);  // over the scatter, at the largest θ
      double log_likelihood = 0.0;
      for (std::size_t r = 0; r < squares.size(); ++r) {
        const double expected = 1.0 + drawn * std::pow(group.share(r), growth);
        log_likelihood -= std::log(expected) + squares[r] / expected;
      }
      if (log_likelihood > best) best = log_likelihood, found = growth;
    }
  return found;
}

/// Weighs residuals so that their mean square is the least-squares slope of their squares over θ to that
/// power, at the largest θ: what draws differ by grows with θ, the scatter does not. Returns the scatter's
/// part of it.
double weigh_by_growth(const Group& group, double growth, Eigen::MatrixXd& missed) {
  const auto runs = static_cast<double>(group.theta.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t r = 0; r < group.theta.size(); ++r) {
    const double grown = std::pow(group.share(r), growth);
    sum += grown / runs, squares += grown * grown / runs;
  }
  for (Eigen::Index r = 0; r < missed.rows(); ++r)
    missed.row(r) *= std::sqrt(std::pow(group.share(static_cast<std::size_t>(r)), growth) / squares);
  return sum / squares;
}

/// What a covariance has beyond the scatter. Of few runs its positive part alone would be a multiple of the
/// scatter along their rows where there is nothing: it gets the size that squares have beyond the scatter's.
Eigen::MatrixXd beyond_scatter(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& scatter) {
  const Eigen::MatrixXd beyond = covariance - scatter;
  Eigen::MatrixXd found = positive_part(beyond);
  const Eigen::ArrayXd unit = scatter.diagonal().array().max(1e-12);
  const double size = (beyond.diagonal().array() / unit).sum(),
               of_found = (found.diagonal().array() / unit).sum();
  return of_found > 0.0 ? Eigen::MatrixXd(std::clamp(size / of_found, 0.0, 1.0) * found) : found;
}

/// The response's own covariance: of that by which runs are missed, beyond the scatter.
void set_draws(const Group& group, Eigen::MatrixXd& missed, const Eigen::MatrixXd& scatter,
               Response& response) {
  response.growth = growth_of(group, missed, scatter);
  const double scattered = weigh_by_growth(group, response.growth, missed);
  response.drawn_at = group.scale();
  response.scatter = scattered * scatter;
  response.draws = beyond_scatter(pairwise(missed, 0.0), response.scatter);
  response.drawn_dof = std::max(2.0, static_cast<double>(group.theta.size()) - group.parameters());
  std::vector<Eigen::Index> complete;
  for (Eigen::Index r = 0; r < missed.rows(); ++r)
    if (missed.row(r).allFinite()) complete.push_back(r);
  response.missed = missed(complete, Eigen::all);
}

}  // namespace

const Signature* Responses::find(const std::string& id) const {
  const auto found =
      std::find_if(signatures.begin(), signatures.end(), [&](const Signature& s) { return s.id == id; });
  return found == signatures.end() ? nullptr : &*found;
}

Eigen::VectorXd Responses::baseline(int member) const {
  const auto own = std::find(members.begin(), members.end(), member);
  if (own == members.end()) return mean;
  const Eigen::VectorXd offset = offsets.row(own - members.begin()).transpose();
  return offset.array().isFinite().select(offset, mean);
}

void Responses::add(const std::string& id, bool below, Response response) {
  auto found =
      std::find_if(signatures.begin(), signatures.end(), [&](const Signature& s) { return s.id == id; });
  if (found == signatures.end()) {
    found = signatures.emplace(signatures.end());
    found->id = id;
    static_cast<Response&>(*found) = response;  // of both signs, until the other one comes
  }
  if (below)
    found->below = std::move(response);
  else
    static_cast<Response&>(*found) = std::move(response);
}

Eigen::MatrixXd positive_part(const Eigen::MatrixXd& covariance) {
  const auto [values, vectors] = eigensystem(0.5 * (covariance + covariance.transpose()));
  return vectors * values.cwiseMax(0.0).asDiagonal() * vectors.transpose();
}

Responses fit_responses(const std::vector<DesignRun>& runs, Eigen::Index features) {
  Responses responses;
  take_baselines(runs, features, responses);
  const auto groups = groups_of(runs, responses);
  std::vector<Response> fits;
  std::vector<Residuals> left(groups.size());
  std::vector<Eigen::MatrixXd> scatter;
  double parameters = 0.0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    fits.push_back(fit_group(groups[g], features, left[g]));
    if (groups[g].draws || groups[g].exact) continue;
    scatter.push_back(left[g].scaled);
    parameters += groups[g].parameters();
  }
  Eigen::MatrixXd all = stacked(scatter, features);
  responses.dof = std::max(1.0, static_cast<double>(all.rows()) - parameters);
  draw_in_outliers(all);
  responses.within = pairwise(all, 0.0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!groups[g].exact) set_draws(groups[g], left[g].missed, responses.within, fits[g]);
    responses.add(groups[g].id, groups[g].below, std::move(fits[g]));
  }
  responses.between = pairwise(responses.offsets.rowwise() - responses.mean.transpose(), 1.0);
  return responses;
}

Scatter scatter_of(const Responses& responses) {
  const double members = static_cast<double>(responses.members.size());
  const Eigen::MatrixXd between = (1.0 + 1.0 / members) * responses.between;
  const Eigen::MatrixXd within = kThresholds.fit_share * responses.within;
  Scatter scatter;
  scatter.covariance = shrunk(between + within);
  const Eigen::VectorXd diagonal = scatter.covariance.diagonal().cwiseMax(1e-12);
  scatter.covariance.diagonal() = diagonal;
  const double share = between.diagonal().cwiseQuotient(diagonal).mean();
  scatter.dof = 1.0 / (share * share / std::max(1.0, members - 1.0) +
                       (1.0 - share) * (1.0 - share) / std::max(1.0, responses.dof));
  return scatter;
}

}  // namespace pendular::diagnosis
