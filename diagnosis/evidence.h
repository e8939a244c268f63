#pragma once

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

namespace pendular::diagnosis {

/// What an effect of magnitude θ does to the features, Σ θ^(k+1) powers[k]; and how large it may be.
struct Signature {
  std::string id;
  std::vector<Eigen::VectorXd> powers;
  double lowest = 0.0, highest = 0.0;  ///< of θ
  double scale = 0.0;                  ///< a usual |θ|
  double least = 0.0;                  ///< |θ| below which the effect counts as absent
  double error = 0.1;                  ///< of each feature's response, as a share of it
  Eigen::MatrixXd draws = {};          ///< covariance of what draws of it differ by, at drawn_at; empty: none
  double drawn_at = 1.0;               ///< θ of that covariance, which grows with θ²

  Eigen::VectorXd at(double theta) const {
    Eigen::VectorXd sum = theta * powers.back();  // Horner's scheme
    for (std::size_t k = powers.size() - 1; k > 0; --k) sum = theta * (powers[k - 1] + sum);
    return sum;
  }
};

/// A gap to be explained. Features are logarithms of ratios or differences of strains; all in one order.
struct Gap {
  Eigen::VectorXd values;  ///< observed less simulated
  Eigen::MatrixXd
      covariance;        ///< of what is neither effect nor believed input: ensemble, measurement, specimen
  double freedom = 0.0;  ///< degrees of freedom of that covariance where it was estimated; 0: known
  /// What known runs leave outside the span of all responses, squared, in units of the noise: how it scatters.
  std::vector<double> outside = {};
  Eigen::MatrixXd believed;  ///< what one standard deviation of each believed input does: a column each
};

/// Prior probabilities: P(none), P(unknown), and how much less a pair is expected than a single effect.
struct Priors {
  double none = 0.2, unknown = 0.15, pairs = 0.15;
};

struct Magnitude {
  double mean = 0.0;  ///< of θ a posteriori
  std::pair<double, double> interval_90 = {0, 0};
};

/// An explanation: none, unknown, one effect, or two ("a+b").
struct Hypothesis {
  std::string id;
  double log_evidence = 0.0;
  double probability = 0.0;
  std::vector<Magnitude> magnitudes;  ///< one per effect
  double misfit = 0.0;                ///< Mahalanobis distance squared of what the best magnitudes leave
};

/// Squares of what gaps with the noise of this one have outside all that responses span, in its units.
std::vector<double> outside_of(const Gap& gap, const std::vector<Signature>& signatures,
                               const std::vector<Eigen::VectorXd>& values);

/// Probabilities over none, every effect, every pair of effects, and unknown; most probable first.
///
/// Believed inputs float within their uncertainties (their responses are part of the covariance), so that an
/// effect earns credit only for what they cannot absorb. Features are reduced to the directions that responses
/// of all effects span beyond the noise; what lies outside counts for all explanations alike but `unknown`. The
/// likelihood is the multivariate t of Sellentin & Heavens (2016, MNRAS 456, L132). Magnitudes are integrated
/// over on a grid; a priori all in the signature's range are alike, those below its least one aside. A response
/// is known to a share of itself (Signature::error), draws of an effect scatter by Signature::draws, and two
/// responses are taken to add to 0.15 of their geometric mean.
///
/// `unknown` is something beside what is known: none or a single effect leaves a residual 1.5, 2.5, 4 or 7 times
/// as large as noise does, within the span and outside it; or, one time in four, something that does what a
/// known effect would do.
std::vector<Hypothesis> weigh(const Gap& gap, const std::vector<Signature>& signatures,
                              const Priors& priors = {});

/// The number of directions that responses span beyond the noise.
Eigen::Index span_of(const Gap& gap, const std::vector<Signature>& signatures);

/// Squared distance, in units of the noise, from each signature at its scale to the nearest that another can
/// make with any magnitude: below nine the two cannot be told apart. The last column is the distance from no
/// effect: what is below nine there cannot be seen.
Eigen::MatrixXd isolability(const Gap& gap, const std::vector<Signature>& signatures);

}  // namespace pendular::diagnosis
