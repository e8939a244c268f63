#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/inference/correction.h"
#include "diagnosis/inference/replay.h"

namespace pendular::diagnosis {

/// How often a probability that was said came true.
struct Reliability {
  double said = 0.0, came_true = 0.0;  ///< mean of the former, share of the latter
  std::size_t cases = 0;
};

/// A replayed run of one effect: its magnitude, whether its set was without none, held the effect, and
/// whether this was the most probable.
struct ReplayedMagnitude {
  double theta = 0.0;
  bool told_from_none = false, in_set = false, first = false;
};

/// What the replay says of an explanation: how many of its runs were told from none, named first, and
/// answered by a right set.
struct EffectReplay {
  std::size_t cases = 0, told_from_none = 0, first = 0, in_set = 0;
  std::vector<ReplayedMagnitude> runs = {};  ///< of a single effect

  /// The least |θ| of its runs from which on nine in ten are told from none; infinite where there is none.
  double seen_from() const;
};

/// What a replay says of mechanisms that the library lacks (Replays::all).
struct OutsideReplay {
  std::size_t cases = 0, flagged = 0, misnamed = 0;  ///< `unknown` in the set; another above nine tenths
};

/// What it says of pairs of effects, each of which is told from none by itself (Replays::all).
struct PairReplay {
  std::size_t cases = 0, in_set = 0, first = 0;
};

/// The explanation that is right for a replayed run: `unknown` where its effect was left out.
std::string truth_of(const Replayed& one);

/// What diagnoses of one experiment promise: found on replayed runs by corrections that were learnt from
/// other members.
struct Promise {
  std::size_t cases = 0;     ///< 0: the bank is too small for a replay; the correction is not learnt
  double confidence = 0.95;  ///< with which sets are to hold the truth
  double in_set = 0.0, set_size = 0.0;
  double theta_held = 0.0;    ///< share of 90 % intervals of θ that hold it, of runs that others span
  double limits_held = 0.0;   ///< share of upper limits (upper_limit()) that |θ| is not above
  double false_alarms = 0.0;  ///< share of runs with no effect or one whose set holds `unknown`
  std::vector<Reliability> reliability;
  EffectReplay none;
  std::map<std::string, EffectReplay> effects;  ///< and pairs that were run
  OutsideReplay outside;
  PairReplay pairs;
  Correction correction;   ///< of measured experiments
  Correction of_replayed;  ///< of replayed runs: `unknown` by Misfit::power_of_replayed
};

/// From replayed runs with no effect, one, or a pair that was run. `confidence` in (0, 1), of measured sets;
/// replayed ones miss 0.4 of what those may. Sets are split-conformal: the least level at which ⌈(n+1) share⌉
/// of n replayed sets hold their truth (Vovk et al. 2005). At that level it is learnt from which magnitude on
/// half of an effect's runs, of either sign, are told from none: none stands for smaller ones (stand_in()),
/// and a set that holds none is right for them; and which pairs are told from none and their effects no more
/// often than slips of 5 % explain (binomial test at 5 %). The level is then found again. Temperatures, of
/// all evidence and of what pairs have beyond their effects, are those of the least logarithmic loss; what is
/// worse than a hundredth counts as that. `unknown` is judged by χ² that runs with one effect or none leave,
/// and by `misfit` (Priors). Intervals of θ hold it at 90 %, those of effects with few runs drawn to what all
/// need; upper limits at 95 %.
///
/// Nothing is learnt from runs whose effect was left out, or that were put together; what becomes of them is
/// counted.
Promise promise_of(const std::vector<Replayed>& replayed, double confidence, const Misfit& misfit = {});

}  // namespace pendular::diagnosis
