#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis_report/table.h"

namespace pendular::diagnosis_report {

/// gap.csv: a row per feature.
Table gap_table(const diagnosis::Diagnosis& diagnosis);

/// The same for the page, in words; significant z have a star.
Table shown_gap_table(const diagnosis::Diagnosis& diagnosis);

/// gap_shares.csv: the share of the gap by scale and by observation.
Table share_table(const diagnosis::Diagnosis& diagnosis);

/// The same for the page, in per cent.
Table shown_share_table(const diagnosis::Diagnosis& diagnosis);

/// noise_budget.csv: what makes up the noise of each feature, standard deviations.
Table noise_table(const diagnosis::Diagnosis& diagnosis);

/// hypotheses.csv: every explanation.
Table hypothesis_table(const diagnosis::Diagnosis& diagnosis);

/// The same for the page: pairs that do not matter summed up in one row; why effects are excluded is said
/// once, in shown_excluded_table().
Table shown_hypothesis_table(const diagnosis::Diagnosis& diagnosis);

/// excluded.csv: the explanations that are excluded, and why.
Table excluded_table(const diagnosis::Diagnosis& diagnosis);

/// The same for the page.
Table shown_excluded_table(const diagnosis::Diagnosis& diagnosis);

/// unseen.csv: effects that may be there though nothing shows them, and how large they may be.
Table unseen_table(const diagnosis::Diagnosis& diagnosis);

/// The same for the page.
Table shown_unseen_table(const diagnosis::Diagnosis& diagnosis);

/// promises.csv: what replayed runs of known truth show of each effect with these observations.
Table promise_table(const diagnosis::Diagnosis& diagnosis);

/// The same for the page, in per cent.
Table shown_promise_table(const diagnosis::Diagnosis& diagnosis);

/// How often what was said with some probability came true among replayed runs.
Table reliability_table(const diagnosis::Diagnosis& diagnosis);

/// The same for the page, in per cent.
Table shown_reliability_table(const diagnosis::Diagnosis& diagnosis);

/// next_experiments.csv: what each further measurement is expected to bring, after what is known without it.
Table next_table(const diagnosis::NextSteps& steps);

/// The same for the page: the probability in per cent.
Table shown_next_table(const diagnosis::NextSteps& steps);

/// next_effects.csv: likewise, effect by effect.
Table next_effects_table(const diagnosis::NextSteps& steps);

/// ledger.csv: every simulated test, those first that were not made.
Table ledger_table(const diagnosis::Diagnosis& diagnosis);

/// How many runs had which purpose, and how many of them were not made.
Table ledger_counts(const diagnosis::Diagnosis& diagnosis);

}  // namespace pendular::diagnosis_report
