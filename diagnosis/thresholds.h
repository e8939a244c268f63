#pragma once

namespace pendular::diagnosis {

/// What decides in the diagnosis: how far simulations are trusted, what counts as seen, when something enters
/// a set or the verdict. What belongs to one kind of observation stands in its file (diagnosis/kinds);
/// numbers that size a computation (cells, draws, steps) stand where they are used; priors and the user's
/// level in Priors and Rules. In brackets what a threshold was set on: [development] a split of
/// docs/blind-scores.md, [engines] docs/engines.md, [replay] replayed runs of a bank, [definition] what a
/// quantity is defined by; else the tests, named as `ctest -R` takes them.
struct DiagnosisThresholds {
  // The bank.
  double about_shown = 1.5;  ///< largest magnitude of the bank over what beads show by themselves [Bank]
  double low_magnitude =
      0.06;  ///< share of a bank's range that scans see, of effects of one sign [development]
  double modulus_share = 0.05;  ///< one standard deviation of the polymer's modulus, where none is stated
  double fraction_sd = 0.01;    ///< of the volume fraction, likewise
  double shown_by = 0.8;        ///< share of runs that must show a feature [Bank]
  double beyond_bank = 1.15;    ///< largest magnitude that is considered, over the bank's [development]

  // Responses.
  double least_room = 0.15;      ///< that a fit leaves a residual, of its variance [Emulator]
  double outlier = 3.0;          ///< robust standard deviations to which residuals are drawn in [Emulator]
  double early_at = 0.05;        ///< of the largest magnitude, where the logarithm begins [Emulator]
  double fit_share = 0.35;       ///< the fit's own variance over the scatter's [Emulator]
  double to_diagonal = 0.35;     ///< share of a covariance that goes to its diagonal [replay]
  double response_error = 0.07;  ///< of a response, as a share of it [development]
  double error_of_beads = 0.4;  ///< the same of effects on bead tables, only nearly found again; what they do
                                ///< to the tables themselves is exact [development]
  double everywhere = 0.3;      ///< share of a response's error that has no direction [development]
  double together = 0.15;       ///< of their geometric mean, by which two effects do not add [development]
  double run_together = 0.07;   ///< likewise, where it was run what they do [development]
  double usual_share = 0.5;     ///< usual magnitude over the bank's largest [definition]
  double least_share = 0.12;    ///< below it an effect counts as absent, unless it is visible [development]
  double visible = 2.0;         ///< standard deviations from none [development]

  // Noise.
  double stress_error = 0.01;  ///< that all stresses of a simulation share [engines]
  double uncorrelated =
      1.0;  ///< of each reading's variance, once more without correlation: members are few [development]
  double law_reading = 0.71;  ///< of what a law's other reading does: √½, either is as likely [definition]
  double law_as_stated = 0.1;  ///< the same where the experiment shows the sample's own [development]
  double decisive = 100.0;     ///< ratio of probabilities that is decisive (Jeffreys) [definition]
  double least_followed = 0.5, most_followed = 1.75;  ///< shares of it that say that it holds [development]
  double followed_by = 3.0;      ///< standard deviations of the share, from which it is said [development]
  double stated_error = 0.2;     ///< of stated standard errors of displacements and necks [development]
  double field_share = 0.15;     ///< error of a reading of a field, of what members scatter by [engines]
  double field_floor = 0.02;     ///< the same, of any reading [engines]
  double unstated_sigma = 1e-3;  ///< of displacements over the beads' diameter, where nothing is stated
  double flank = 0.15;           ///< share of a measured variance of contact gaps [ContactFeatures]
  double stated_variance = 0.3;  ///< what stated variances of bead tables may be off by [ContactFeatures]
  double most_dof = 100.0;       ///< most that the likelihood trusts a covariance with [replay]

  // Fields.
  double least_mode = 0.05;   ///< µm, rms per bead: below it a difference is no mode [FieldStatistics]
  double coherent = 0.3;      ///< share of the squares that repeats from run to run [FieldStatistics]
  double independent = 0.05;  ///< of the largest singular value of modes [FieldStatistics]
  double size_floor =
      0.25;  ///< of the noise's variance, below which sizes are not told apart [FieldStatistics]

  // Directions of the evidence, and what is outside them.
  double least_direction = 0.5;  ///< singular value of the responses, in units of the noise [replay]
  double longest = 8.0;          ///< a response counts no more than this for the directions [replay]
  double fresh = 1.3;  ///< squares outside, of an observation over those of runs learnt from [replay]

  // Replay, probabilities and sets.
  double of_theta = 0.9;          ///< runs whose interval holds their magnitude [definition]
  double of_limits = 0.95;        ///< runs whose upper limit holds [definition]
  double missed_by_replay = 0.4;  ///< of what sets may miss, where runs are replayed: measured ones are
                                  ///< missed more often, since no law is quite theirs [development]
  double strong = 10.0;           ///< ratio of evidences that is strong (Jeffreys) [definition]
  double told = 0.5;         ///< runs told from none, below which none stands for an effect [development]
  double seen = 0.9;         ///< runs told from none, from where an effect is seen on [definition]
  double by_slip = 0.05;     ///< level of the test that a pair is told from its effects [definition]
  double unlike_all = 0.05;  ///< odds before any data of what no effect brings about: `unknown` comes in
                             ///< where that has a probability by chance below 0.008 [definition]
  double least_by_chance = 1e-4;  ///< the least probability that it may have by chance [definition]
  double worth_of_all = 10.0;    ///< runs that what all effects need is worth beside an effect's own [replay]
  double lets_unknown_in = 0.3;  ///< P(unknown) from which it is in a set [development]
  double least_in_set = 0.01;    ///< probability from which an explanation is in a set [development]
  double least_in_cluster = 40.0;  ///< runs [replay]
  double less_in_cluster = 0.05;   ///< confidence that one cluster may have less than all together [replay]
  double least_cases = 60.0;       ///< from which a replay is believed [Calibration]

  // Runs at the leading explanations, further measurements, verdict.
  double pair_leads = 0.01, leads = 0.05;  ///< probabilities from which runs are made [development]
  double fit_leads = 0.01;                 ///< likewise, where an explanation fits best [development]
  double alone = 0.95;  ///< probability from which one that leaves the noise alone needs none [definition]
  double in_question = 0.02;  ///< probability from which a measurement is to tell it [development]
  double short_test = 0.025;  ///< platen strain to which tests are run without being asked for, to assess
                              ///< further measurements: scans at 1 and 2 % [definition]
  double gain = 0.02;         ///< bits below which nothing is gained [definition]
  double with_pairs =
      10.0;  ///< an effect may have so many times more in pairs and still be excluded [Judgement]
  double contradiction = 4.0;  ///< standard deviations between two measurements of one thing [Diagnose]
  double likely = 0.5;         ///< probability from which a cause is named [definition]

  // Places.
  double false_places = 0.05;  ///< probability that the map shows a place where there is none [definition]
  double least_misfit = 2.0;   ///< of a bead: a packing without a flaw has 1.96 [docs/place.md]
  double share_of_largest = 1.0 / 3;  ///< of the largest misfit, from which a bead is of the place [Place]
  double tail = 0.05;  ///< of the beads that stand out, beyond the range that is told [definition]
};

inline constexpr DiagnosisThresholds kThresholds;

}  // namespace pendular::diagnosis
