#include "diagnosis/evidence.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "diagnosis/reduced_space.h"

namespace pendular::diagnosis {
namespace {

constexpr int kCellsOfOne = 81, kCellsOfTwo = 11;  // of each effect's range
constexpr int kRefined = 2, kParts = 4;            // how often cells at the peak are cut, and into how many
constexpr double kUnknownFactors[] = {1.0, 1.5, 2.5, 4.0, 7.0};  // of the noise's standard deviation
constexpr double kTogether = 0.15;   // of their geometric mean, by which two effects do not add
constexpr double kRunTogether = 0.07;  // likewise, where it was run what they do
constexpr double kEverywhere = 0.3;  // share of a response's error that has no direction
constexpr double kNever = -std::numeric_limits<double>::infinity();

double log_sum(const std::vector<double>& terms) {
  const double largest = *std::max_element(terms.begin(), terms.end());
  if (!std::isfinite(largest)) return largest;
  double sum = 0.0;
  for (double term : terms) sum += std::exp(term - largest);
  return largest + std::log(sum);
}

/// Some magnitudes of an effect, for which the one in the middle stands.
struct Cell {
  double theta = 0.0, width = 0.0;
};

/// A cell of each effect of an explanation, and what it weighs.
struct Place {
  std::vector<Cell> cells;
  double log_prior = 0.0;
  ReducedSpace::Fit fit = {};

  double log_weight() const { return log_prior + fit.log_likelihood; }
  double log_density() const {
    double density = log_weight();
    for (const auto& cell : cells) density -= std::log(cell.width);
    return density;
  }
};

/// One or two cells, each cut into so many.
std::vector<std::vector<Cell>> parts_of(const std::vector<Cell>& cells, int parts) {
  std::vector<std::vector<Cell>> found = {{}};
  for (const auto& cell : cells) {
    std::vector<std::vector<Cell>> longer;
    for (const auto& so_far : found)
      for (int k = 0; k < parts; ++k) {
        longer.push_back(so_far);
        longer.back().push_back({cell.theta + cell.width * ((k + 0.5) / parts - 0.5), cell.width / parts});
      }
    found = std::move(longer);
  }
  return found;
}

/// All magnitudes are alike a priori, those below the least one aside.
double log_prior_of(const Signature& signature, const Cell& cell) {
  if (std::fabs(cell.theta) < signature.least) return kNever;
  const double absent = std::max(0.0, std::min(signature.highest, signature.least) -
                                          std::max(signature.lowest, -signature.least));
  return std::log(cell.width / (signature.highest - signature.lowest - absent));
}

/// How a reduced response is known: to a share of itself, and to what its draws differ by.
Eigen::MatrixXd covariance_of(const Signature& reduced, double theta, const Eigen::VectorXd& response) {
  const double everywhere =
      kEverywhere * response.squaredNorm() / std::max<double>(1.0, static_cast<double>(response.size()));
  Eigen::MatrixXd covariance =
      (reduced.error * reduced.error * (response.array().square() + everywhere)).matrix().asDiagonal();
  const Response& here = reduced.response(theta);
  if (here.draws.size() > 0) covariance += here.draws * std::pow(theta / here.drawn_at, 2);
  return covariance;
}

/// One effect or two together, at all their magnitudes: cells, cut finer about the peak, since a field may say
/// a magnitude far better than a grid over its range has cells.
class Explored {
 public:
  Explored(std::vector<const Signature*> reduced, const Together* together, const ReducedSpace& space, int cells)
      : reduced_(std::move(reduced)), together_(together), space_(space) {
    std::vector<Cell> whole;
    for (const auto* one : reduced_)
      whole.push_back({0.5 * (one->lowest + one->highest), one->highest - one->lowest});
    add(parts_of(whole, cells));
    for (int round = 0; round < kRefined; ++round) refine();
  }

  const std::vector<Place>& places() const { return places_; }

  Hypothesis hypothesis() const {
    Hypothesis found{"", 0.0, 0.0, {}, std::numeric_limits<double>::infinity()};
    std::vector<double> weights;
    for (const auto& place : places_) {
      weights.push_back(place.log_weight());
      found.misfit = std::min(found.misfit, place.fit.misfit);
    }
    found.log_evidence = log_sum(weights);
    for (std::size_t e = 0; e < reduced_.size(); ++e) {
      found.id += (e > 0 ? "+" : "") + reduced_[e]->id;
      found.magnitudes.push_back(magnitude(e, found.log_evidence));
    }
    return found;
  }

 private:
  void add(const std::vector<std::vector<Cell>>& all) {
    for (const auto& cells : all) {
      Place place{cells};
      for (std::size_t e = 0; e < cells.size(); ++e) place.log_prior += log_prior_of(*reduced_[e], cells[e]);
      if (place.log_prior == kNever) continue;
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(space_.size());
      Eigen::VectorXd product = Eigen::VectorXd::Constant(space_.size(), cells.size() > 1 ? 1.0 : 0.0);
      Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(space_.size(), space_.size());
      double outside = 0.0;
      for (std::size_t e = 0; e < cells.size(); ++e) {
        const Eigen::VectorXd response = reduced_[e]->at(cells[e].theta);
        sum += response;
        product = product.cwiseProduct(response);
        covariance += covariance_of(*reduced_[e], cells[e].theta, response);
        const Response& here = reduced_[e]->response(cells[e].theta);
        outside += std::pow(reduced_[e]->outside, 2) * response.squaredNorm() +
                   std::pow(cells[e].theta / here.drawn_at, 2) * here.drawn_outside;
      }
      if (together_)
        sum += cells[0].theta / together_->theta_a * cells[1].theta / together_->theta_b * together_->beyond;
      covariance.diagonal() += std::pow(together_ ? kRunTogether : kTogether, 2) * product.cwiseAbs();
      place.fit = space_.fit(sum, covariance, outside);
      places_.push_back(std::move(place));
    }
  }

  void refine() {
    if (places_.empty()) return;
    const auto best = std::max_element(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
      return a.log_density() < b.log_density();
    })->cells;
    std::vector<std::vector<Cell>> finer;
    std::erase_if(places_, [&](const Place& place) {
      for (std::size_t e = 0; e < best.size(); ++e)
        if (std::fabs(place.cells[e].theta - best[e].theta) > 0.75 * (place.cells[e].width + best[e].width))
          return false;
      const auto parts = parts_of(place.cells, kParts);
      finer.insert(finer.end(), parts.begin(), parts.end());
      return true;
    });
    add(finer);
  }

  /// Mean and interval of one effect's magnitude a posteriori: each cell's weight is spread over its width.
  Magnitude magnitude(std::size_t effect, double log_evidence) const {
    std::vector<std::pair<Cell, double>> cells;
    Magnitude found;
    for (const auto& place : places_) {
      cells.emplace_back(place.cells[effect], std::exp(place.log_weight() - log_evidence));
      found.mean += cells.back().second * cells.back().first.theta;
    }
    const auto below = [&](double theta) {
      double sum = 0.0;
      for (const auto& [cell, weight] : cells)
        sum += weight * std::clamp((theta - cell.theta) / cell.width + 0.5, 0.0, 1.0);
      return sum;
    };
    const auto quantile = [&](double share) {
      double low = reduced_[effect]->lowest, high = reduced_[effect]->highest;
      for (int step = 0; step < 40; ++step) (below(0.5 * (low + high)) < share ? low : high) = 0.5 * (low + high);
      return 0.5 * (low + high);
    };
    found.interval_90 = {quantile(0.05), quantile(0.95)};
    return found;
  }

  std::vector<const Signature*> reduced_;
  const Together* together_;  // of two, if they were run; reduced
  const ReducedSpace& space_;
  std::vector<Place> places_;
};

/// An explanation, and what it would come to beside something unknown.
struct Weighed {
  Hypothesis hypothesis;
  double beside_unknown = 0.0;  // logarithm of the evidence with wider noise
};

/// Mean over the widths of the noise within the span and outside it, of which at least one is larger: what is
/// unknown may look like the known, or like nothing that is known.
double beside_unknown(const ReducedSpace& space, const ReducedSpace::Fit& fit) {
  std::vector<double> terms;
  for (double within : kUnknownFactors)
    for (double outside : kUnknownFactors)
      if (within > 1.0 || outside > 1.0) terms.push_back(space.widened(fit, within, outside));
  return log_sum(terms) - std::log(static_cast<double>(terms.size()));
}

Weighed none(const ReducedSpace& space) {
  const auto fit =
      space.fit(Eigen::VectorXd::Zero(space.size()), Eigen::MatrixXd::Zero(space.size(), space.size()), 0.0);
  return {{"none", fit.log_likelihood, 0.0, {}, fit.misfit}, beside_unknown(space, fit)};
}

Weighed single(const Signature& reduced, const ReducedSpace& space) {
  const Explored explored({&reduced}, nullptr, space, kCellsOfOne);
  std::vector<double> beside;
  for (const auto& place : explored.places())
    beside.push_back(place.log_prior + beside_unknown(space, place.fit));
  return {explored.hypothesis(), log_sum(beside)};
}

/// Something beside what is known, or, by chance, something that does what a known effect would.
Hypothesis unknown(const std::vector<Weighed>& known, double like_known) {
  std::vector<double> beside, like;
  for (const auto& one : known) {
    beside.push_back(one.beside_unknown);
    if (one.hypothesis.magnitudes.size() == 1) like.push_back(one.hypothesis.log_evidence);
  }
  const auto mean = [](const std::vector<double>& terms) {
    return log_sum(terms) - std::log(static_cast<double>(terms.size()));
  };
  const double other = mean(beside);
  if (like.empty()) return {"unknown", other, 0.0, {}, known.front().hypothesis.misfit};
  return {"unknown", log_sum({other + std::log(1.0 - like_known), mean(like) + std::log(like_known)}), 0.0, {},
          known.front().hypothesis.misfit};
}

/// Evidences times priors, made to sum to one; most probable first.
void make_probabilities(std::vector<Hypothesis>& hypotheses,
                        const std::function<double(const Hypothesis&)>& prior) {
  std::vector<double> log_weight;
  for (const auto& h : hypotheses) log_weight.push_back(h.log_evidence + std::log(prior(h)));
  const double total = log_sum(log_weight);
  for (std::size_t k = 0; k < hypotheses.size(); ++k)
    hypotheses[k].probability = std::exp(log_weight[k] - total);
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

/// What two effects do together, reduced, in their order; none where they were not run.
std::optional<Together> together_of(const std::vector<Together>& all, const Signature& a, const Signature& b,
                                    const ReducedSpace& space) {
  for (Together one : all) {
    if (one.a == b.id && one.b == a.id) std::swap(one.a, one.b), std::swap(one.theta_a, one.theta_b);
    if (one.a != a.id || one.b != b.id) continue;
    one.beyond = space.reduced(one.beyond);
    return one;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Hypothesis> weigh(const Gap& gap, const std::vector<Signature>& signatures,
                              const std::vector<Together>& together, const Priors& priors, Pairs which) {
  const ReducedSpace space(gap, signatures);
  std::vector<Weighed> known = {none(space)};
  std::vector<Signature> reduced;
  for (const auto& signature : signatures) {
    reduced.push_back(space.reduced(signature));
    known.push_back(single(reduced.back(), space));
  }
  std::vector<Hypothesis> all = {unknown(known, priors.like_known)};
  for (const auto& one : known) all.push_back(one.hypothesis);
  for (std::size_t a = 0; a < reduced.size(); ++a)
    for (std::size_t b = a + 1; b < reduced.size(); ++b) {
      const auto run = together_of(together, reduced[a], reduced[b], space);
      if (run || which == Pairs::all)
        all.push_back(Explored({&reduced[a], &reduced[b]}, run ? &*run : nullptr, space, kCellsOfTwo).hypothesis());
    }
  const double effects = static_cast<double>(signatures.size());
  const double pairs = effects > 1.0 ? priors.pairs : 0.0;
  make_probabilities(all, [&](const Hypothesis& h) {
    if (h.id == "none") return priors.none;
    if (h.id == "unknown") return priors.unknown;
    if (h.magnitudes.size() == 2) return pairs / (0.5 * effects * (effects - 1.0));
    return (1.0 - priors.none - priors.unknown - pairs) / effects;
  });
  return all;
}

Eigen::MatrixXd isolability(const Gap& gap, const std::vector<Signature>& signatures) {
  const ReducedSpace space(gap, signatures);
  const auto size = static_cast<Eigen::Index>(signatures.size());
  Eigen::MatrixXd distance = Eigen::MatrixXd::Zero(size, size + 1);
  std::vector<Signature> reduced;
  for (const auto& signature : signatures) reduced.push_back(space.reduced(signature));
  for (Eigen::Index a = 0; a < size; ++a) {
    const auto& signature = signatures[static_cast<std::size_t>(a)];
    const Eigen::VectorXd here = reduced[static_cast<std::size_t>(a)].at(signature.scale);
    distance(a, size) = here.squaredNorm();
    for (Eigen::Index b = 0; b < size; ++b) {
      if (a == b) continue;
      distance(a, b) = distance(a, size);
      const Signature& other = reduced[static_cast<std::size_t>(b)];
      for (const auto& cells : parts_of({{0.5 * (other.lowest + other.highest), other.highest - other.lowest}}, kCellsOfOne))
        distance(a, b) = std::min(distance(a, b), (here - other.at(cells.front().theta)).squaredNorm());
    }
  }
  return distance;
}

}  // namespace pendular::diagnosis
