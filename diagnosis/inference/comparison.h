#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/bank/design.h"
#include "diagnosis/inference/gap.h"

namespace pendular::effects {
struct Effect;
}

namespace pendular::diagnosis {

struct LawReading;

/// What the other reading of a law does: its mean, and the covariance by which members differ from that.
struct LawResponse {
  std::string id;
  Eigen::VectorXd mean;
  Eigen::MatrixXd scatter;
};

/// Observation and simulation at one level: all vectors in the order of `observed`.
struct Comparison {
  ObservedFeatures observed;
  Eigen::VectorXd simulated;  ///< as believed, as features are compared
  Gap gap;
  std::vector<std::string> inputs;    ///< what the columns of gap.believed are responses to
  std::vector<Signature> signatures;  ///< of the effects
  std::vector<Together> together;     ///< of those that were run together
  std::vector<LawResponse> laws;
  std::vector<NoiseBudget> noise;
};

/// The names of columns of gap.believed that are no keys of the sample.
inline constexpr const char* kSimulationError = "stresses of the simulation";
inline constexpr const char* kBeadsError = "measured centres and diameters";
inline constexpr const char* kCurvature = ", squared";  ///< after a key: what its response is not a line by
inline constexpr const char* kFieldError = "stated errors of displacements";

/// How large a share of what the other reading of a law does is noise, as a standard deviation.
double share_of_law(const BankPlan& plan, const LawReading& law);

/// Responses, noise and gap as a design shows them. `plan`: of its bank.
Comparison compare(const Experiment& experiment, const BankPlan& plan, const Design& design);

/// A |θ| of an effect that is usual, at which signatures and separations are told: half the largest of its
/// bank.
double usual_magnitude(const effects::Effect& effect);

/// Of some effects, by their ids.
using Magnitudes = std::map<std::string, Magnitude>;

/// What an explanation, these effects, leaves of the gap.
Eigen::VectorXd left_by(const Comparison& comparison, const Magnitudes& magnitudes);

/// Means a posteriori of what the columns of gap.believed are responses to, in standard deviations, where
/// this is left of the gap.
Eigen::VectorXd pulls_of(const Gap& gap, const Eigen::VectorXd& left);

/// A matrix whose product with its transpose is a covariance.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance);

/// The gap of some features alone, in that order.
Gap part_of(const Gap& gap, const std::vector<std::size_t>& features);
std::vector<Signature> part_of(const std::vector<Signature>& signatures,
                               const std::vector<std::size_t>& features);
std::vector<Together> part_of(const std::vector<Together>& together,
                              const std::vector<std::size_t>& features);

/// The features of one of these observations.
std::vector<std::size_t> features_from(const Comparison& comparison,
                                       const std::vector<std::size_t>& observations);

}  // namespace pendular::diagnosis
