#include "diagnosis/inference/ways.h"

#include <cmath>
#include <limits>

#include "diagnosis/inference/log_sum.h"

namespace pendular::diagnosis {
namespace {

constexpr double kScales[] = {0.4, 0.63, 1.0, 1.6, 2.5};  // of standard deviations
constexpr double kScaleWeights[] = {0.1, 0.24, 0.32, 0.24, 0.1};
constexpr double kUnknownFactors[] = {1.0, 1.5, 2.5, 4.0, 7.0};  // of the noise's standard deviation

}  // namespace

std::vector<Way> ways_of(const ReducedSpace& space, const Eigen::VectorXd& response, const Errors& errors,
                         double drawn_outside) {
  const double other = space.other_law();
  std::vector<Way> ways;
  const auto add = [&](double prior, double scale, bool other_law) {
    Errors scaled = errors;
    scaled.draws *= scale * scale;
    scaled.outside += scale * scale * drawn_outside;
    ways.push_back({std::log(prior), space.predict(response, scaled, other_law)});
  };
  for (std::size_t k = 0; k < std::size(kScales); ++k)
    add((1.0 - other) * kScaleWeights[k], kScales[k], false);
  if (other > 0.0) add(other, 1.0, true);
  return ways;
}

WaysFit fit(const ReducedSpace& space, const ReducedGap& gap, const std::vector<Way>& ways) {
  WaysFit fit;
  std::vector<double> terms;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const Fit one = space.fit(gap, ways[k].prediction);
    fit.chi_squareds[k] = one.chi_squared;
    terms.push_back(ways[k].log_prior + one.log_likelihood);
    if (terms.back() > most) most = terms.back(), fit.chi_squared = one.chi_squared;
  }
  fit.log_likelihood = log_sum(terms);
  return fit;
}

double beside_unknown(const ReducedSpace& space, const ReducedGap& gap, const std::vector<Way>& ways,
                      const WaysFit& fit) {
  constexpr double kEach = std::size(kUnknownFactors) * std::size(kUnknownFactors) - 1.0;
  std::vector<double> terms;
  for (std::size_t k = 0; k < ways.size(); ++k)
    for (const double within : kUnknownFactors)
      for (const double outside : kUnknownFactors)
        if (within > 1.0 || outside > 1.0)
          terms.push_back(ways[k].log_prior - std::log(kEach) +
                          space.widened(gap, ways[k].prediction, fit.chi_squareds[k], within, outside));
  return log_sum(terms);
}

}  // namespace pendular::diagnosis
