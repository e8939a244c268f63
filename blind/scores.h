#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "blind/alike.h"
#include "blind/proportion.h"

namespace pendular::blind {

/// What verdicts come to, for all cases or for one stratum. Cases without a diagnosis count as wrong, with no
/// probability for the truth.
struct Naming {
  Proportion in_set;             ///< the right answer is in the ambiguity set
  Proportion exact;              ///< it is the most probable
  Proportion exact_separable;    ///< the same, of cases whose set has one member
  Proportion confidently_wrong;  ///< something else has a probability above 0.9
  double set_size = 0.0;         ///< mean, of the cases with a diagnosis; right answers count as one
  double log_score = 0.0;        ///< mean of −ln P(truth), P at least kLeastProbability
  double brier = 0.0;  ///< mean over cases of Σ (P − truth)² over explanations; 2 without diagnosis
};
inline constexpr double kLeastProbability = 1e-6;

/// How often what was said with some probability was right.
struct ReliabilityBin {
  double from = 0.0, to = 1.0;
  double mean_probability = 0.0;  ///< of the most probable explanations in the bin
  Proportion right, right_by_class;
};

/// θ of the true effect where one effect of the library was withheld and it has a magnitude in the report.
struct MagnitudeScore {
  double median_relative_error = 0.0;
  Proportion covered;  ///< by the 90 % interval
};

/// Share of the gap on withheld observations that was closed; medians, of the cases with a library effect
/// whose report has it. `by` is of the retuned modulus: median of the differences.
struct ShrinkageScore {
  std::size_t cases = 0;
  double withheld = 0.0, retuned = 0.0, wrong_effect = 0.0, above_retuned = 0.0;
  /// Where it is known what the true effects close (measure_oracles()): that, what was closed, and in how
  /// many cases it was 0.7 of that and more.
  std::size_t oracles = 0;
  double closable = 0.0, closed = 0.0;
  Proportion reached;
};

/// What replays expect of cases that they stand for, in the mean, and what came of these.
struct Expectation {
  double expected = 0.0;
  Proportion came;
};

/// What diagnoses promise beside what came of it, for all cases or for one stratum.
struct Kept {
  /// Cases that the replay stands for: nothing or one effect withheld, and a promise. Means of what it said.
  std::size_t promises = 0;
  double promised_in_set = 0.0, promised_size = 0.0, promised_theta = 0.0, promised_alarms = 0.0;
  Expectation there;          ///< of those whose magnitude was replayed: Verdict::promised_in_set()
  Proportion in_set;          ///< of the same cases: Verdict::set_is_right()
  double set_size = 0.0;      ///< likewise
  Proportion unknown_alarms;  ///< right answer not `unknown`, and it is in the set
  /// Upper limits of hardly shown effects that are there, hidden ones too: |θ| is not above.
  Proportion limits;
  MagnitudeScore magnitude;
  Proportion confidently_wrong;
  std::vector<ReliabilityBin> reliability;
};

/// What is promised, of cases with the same observations.
struct Bars {
  Naming naming;
  Proportion set_is_right;  ///< Verdict::set_is_right()
  Proportion single_first;  ///< one effect was withheld, and it is the most probable
  Proportion pairs_in_set;
  Proportion flagged;        ///< outside mechanisms: `unknown` is in the set or first
  Proportion misnamed;       ///< outside mechanisms: something else above 0.9
  MagnitudeScore magnitude;  ///< of single effects
  /// By replays of the same observations: Verdict::promised_in_set(), promised_first(), promised_flagged().
  Expectation in_set_there, first_there, pairs_there, flagged_there;
};

/// Cases whose effect is too small to be seen, which count nowhere else.
struct HiddenScore {
  Proportion allowed;   ///< `none` or the effect is in the set
  Proportion misnamed;  ///< something else has a probability above 0.9
};

struct Scores {
  bool without_truth = false;
  std::size_t cases = 0, failed = 0;
  Naming all;
  Naming all_by_class;             ///< answers that an ideal observer cannot tell apart are one
  std::size_t with_distances = 0;  ///< cases whose diagnosis says which these are
  std::map<Stratum, Naming> by_stratum, by_stratum_and_class;
  Kept kept;
  std::map<Stratum, Kept> kept_by_stratum;
  std::map<std::string, Naming> by_answer;
  double prior_log_score = 0.0, prior_brier = 0.0;  ///< of the priors alone
  Proportion nearest_signature;                     ///< exact, where reports name it
  Proportion false_alarms;                          ///< nothing withheld, and `none` not in the set
  Proportion none_not_first;                        ///< nothing withheld, and something else first
  Proportion flagged;   ///< right answer unknown: it is in the set or the most probable
  Proportion misnamed;  ///< right answer unknown: something else above 0.9
  double auroc_unknown = 0.0;
  MagnitudeScore magnitude, magnitude_where_named;
  ShrinkageScore shrinkage;
  std::array<Bars, kObserved> by_observed;                 ///< of all engines
  Bars other_engine_without_scan, other_engine_with_scan;  ///< of the stratum other_engine alone
  HiddenScore hidden;
};

Scores score(const std::vector<Verdict>& all, bool without_truth);

/// −ln P(truth) and Brier score of one case.
double log_score(const Verdict& verdict, Counting counting = Counting::by_name);
double brier_score(const Verdict& verdict, Counting counting = Counting::by_name);

}  // namespace pendular::blind
