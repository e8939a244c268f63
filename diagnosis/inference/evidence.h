#pragma once

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/bank/signature.h"

namespace pendular::diagnosis {

/// How the odds of `unknown` to an explanation grow with what it leaves: odds q^−power, of the share q of
/// replayed runs that leave more. Fitted to development cases (docs/blind-scores.md).
struct Misfit {
  double odds = 0.06, power = 1.6;
  double power_of_replayed = 0.53;  ///< of replayed runs, which leave more than measured experiments do: each
                                    ///< has errors of the law that few of these have
};

/// Prior probabilities: P(none), P(unknown), and how much less a pair is expected than a single effect.
struct Priors {
  double none = 0.2, unknown = 0.15, pairs = 0.15;
  double like_known = 0.5;  ///< of unknown mechanisms: that it does what an effect of the library would
  Misfit misfit = {};
};

struct Magnitude {
  double mean = 0.0;  ///< of θ a posteriori
  std::pair<double, double> interval_90 = {0, 0};
  std::size_t reading = 0;  ///< the most probable one of the effect's (Signature::response())
};

/// The explanation that stands for all pairs that were not run (corrected()).
inline constexpr const char* kOtherPairs = "other_pairs";

/// An explanation: none, unknown, one effect, two ("a+b"), or kOtherPairs.
struct Hypothesis {
  std::string id;
  double log_evidence = 0.0;
  double probability = 0.0;
  std::vector<Magnitude> magnitudes;  ///< one per effect
  double chi_squared = 0.0;           ///< at the best magnitudes
  bool run = true;                    ///< of a pair: it was run what they do together
  double log_prior = 0.0;             ///< up to a term that all have
};

/// Effects that an explanation names: none in "none", "unknown" and kOtherPairs, two in "a+b".
std::vector<std::string> effects_in(const std::string& id);
/// Whether it names two effects.
inline bool names_two(const std::string& id) {
  return id.find('+') != std::string::npos;
}

/// Which pairs are weighed: all, or those that were run and those of the observation's most probable single
/// effect.
enum class Pairs { all, leading };

/// Probabilities over none, every effect, every pair of effects, and unknown; most probable first.
///
/// Believed inputs float within their uncertainties (their responses are part of the covariance), so that an
/// effect earns credit only for what they cannot absorb. Features are reduced to the directions that
/// responses of all effects span beyond the noise; what lies outside counts for all explanations alike but
/// `unknown`. The likelihood is the multivariate t of Sellentin & Heavens (2016, MNRAS 456, L132). Magnitudes
/// are integrated over on a grid, finer about its peak; a priori all in the signature's range are alike,
/// those aside that are below its least one and less than two standard deviations from none. A response is
/// known to a share of itself (Signature::error) and to Response::draws, at 0.4 to 2.5 times its standard
/// deviations, and two responses are taken to add to 0.15 of their geometric mean, to 0.07 of it where they
/// were run together. Where an explanation was run as it fits,
/// Gap::at_fit is part of it; one that was not takes that of the nearest that was: a pair of its effect of
/// more evidence, an effect of none.
///
/// `unknown` is something beside what is known: none or a single effect leaves a residual 1.5, 2.5, 4 or 7
/// times as large as noise does, within the span, outside it, or both; or (Priors::like_known) something that
/// does what a known effect would do. Where it has no prior probability it is not weighed.
std::vector<Hypothesis> weigh(const Gap& gap, const std::vector<Signature>& signatures,
                              const std::vector<Together>& together = {}, const Priors& priors = {},
                              Pairs pairs = Pairs::all);

/// Squared distance, in units of the noise, from each signature at its scale, at the sign that shows more, to
/// the nearest that another can make with any magnitude: below nine the two cannot be told apart. The last
/// column is the distance from no effect: what is below nine there cannot be seen.
Eigen::MatrixXd isolability(const Gap& gap, const std::vector<Signature>& signatures);

}  // namespace pendular::diagnosis
