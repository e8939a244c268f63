#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "diagnosis/inference/evidence.h"
#include "diagnosis/inference/reduced_space.h"

namespace pendular::diagnosis {

/// weigh() for many gaps that have the same noise and the same responses: what explanations say of some is
/// worked out once. `gap.values` are not read. May be called from several threads.
class Weigher {
 public:
  Weigher(const Gap& gap, const std::vector<Signature>& signatures,
          const std::vector<Together>& together = {}, const Priors& priors = {}, Pairs pairs = Pairs::all);
  Weigher(const Weigher&) = delete;  // its parts refer to its space
  Weigher& operator=(const Weigher&) = delete;

  /// The explanations of each of some observations: observed less simulated, as Gap::values. Magnitudes of
  /// effects whose evidence is less than e^−negligible of the best one's are told coarsely.
  std::vector<std::vector<Hypothesis>> operator()(
      const std::vector<Eigen::VectorXd>& observed,
      double negligible = std::numeric_limits<double>::infinity()) const;

  const ReducedSpace& space() const { return space_; }

  /// Whether an effect of this magnitude counts as absent: below its least one, and not seen here.
  bool absent(const std::string& effect, double theta) const;

 private:
  /// Unknown, none and single effects, before probabilities.
  std::vector<std::vector<Hypothesis>> of_singles(const std::vector<ReducedGap>& gaps,
                                                  double negligible) const;

  struct Pair {
    std::size_t a, b;
    std::optional<Together> run;
  };
  /// Adds the pairs to what is said of each gap.
  void add_pairs(const std::vector<ReducedGap>& gaps, double negligible,
                 std::vector<std::vector<Hypothesis>>& all) const;

  /// What was run at the first of these explanations that was run as it fits; null where none was.
  const AtFit* at_fit_near(const std::vector<std::string>& ids) const;
  /// That of a pair or, where it was not run so, of its effect of more evidence: the nearest that was.
  const AtFit* at_fit_near(const Pair& pair, const std::vector<Hypothesis>& singles) const;

  /// Whether a pair is weighed for an observation, of which single effects are weighed already.
  bool matters(const Pair& pair, const std::vector<Hypothesis>& singles) const;

  ReducedSpace space_;
  Priors priors_;
  Pairs which_;
  std::vector<Signature> reduced_;
  std::vector<Pair> pairs_;
  std::vector<AtFit> at_fit_;  // reduced
};

}  // namespace pendular::diagnosis
