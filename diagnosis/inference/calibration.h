#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/inference/replay.h"

namespace pendular::diagnosis {

/// How often a probability that was said came true.
struct Reliability {
  double said = 0.0, came_true = 0.0;  ///< mean of the former, share of the latter
  std::size_t cases = 0;
};

/// What the replay says of an effect, or of a pair that was run: how many of its runs were told from none,
/// named first, and answered by a right set.
struct EffectReplay {
  std::size_t cases = 0, told_from_none = 0, first = 0, in_set = 0;
};

/// How probabilities, sets and intervals are made to hold what they promise, learnt from a replay; as it
/// stands, for a bank that is too small for one: wide.
struct Correction {
  double temperature = 2.0;                   ///< by which logarithms of evidence are divided
  double level = 0.95;                        ///< of the known explanations' probability, that a set holds
  std::map<std::string, double> levels = {};  ///< likewise, for explanations that need another one to get in
  double gate = 0.1;                          ///< probability of `unknown` from which it belongs to the set
  std::map<std::string, double> widening = {};  ///< of an effect's interval of θ
  double widening_of_others = 2.0;
  double widening_of_limits = 2.0;  ///< of upper limits of |θ|, beside that of intervals
  /// Effects that a set which holds none does not hold; pairs that it does not hold beside a more probable
  /// effect of theirs, or none, unless their evidence is ten times as large.
  std::set<std::string> unseen = {};
};

/// What a replay says of mechanisms that the library lacks (LeftOut::effects).
struct OutsideReplay {
  std::size_t cases = 0, flagged = 0, misnamed = 0;  ///< `unknown` in the set; another above nine tenths
};

/// The explanation that is right for a replayed run: `unknown` where its effect was left out.
std::string truth_of(const Replayed& one);

/// Upper limit of |θ|, at 95 %, of an effect that is there: the farther end of its corrected interval,
/// widened.
double upper_limit(const Magnitude& magnitude, const Correction& correction);

/// What a set of explanations is made of.
struct AmbiguitySet {
  std::vector<std::string> ids;  ///< best first
  double probability = 0.0;
};

/// What diagnoses of one experiment promise: found on replayed runs by corrections that were learnt from
/// other members.
struct Promise {
  std::size_t cases = 0;     ///< 0: the bank is too small for a replay; the correction is not learnt
  double confidence = 0.95;  ///< with which sets are to hold the truth
  double in_set = 0.0, set_size = 0.0;
  double theta_held = 0.0;    ///< share of 90 % intervals of θ that hold it
  double limits_held = 0.0;   ///< share of upper limits (upper_limit()) that |θ| is not above
  double false_alarms = 0.0;  ///< share of known runs whose set holds `unknown`
  std::vector<Reliability> reliability;
  std::map<std::string, EffectReplay> effects;
  OutsideReplay outside;
  Correction correction;
};

/// From replayed runs with no effect, one, or a pair that was run. `confidence` in (0, 1). Sets are
/// split-conformal: the least level at which ⌈(n+1) confidence⌉ of n replayed sets hold their truth (Vovk et
/// al. 2005). Effects whose runs are told from none at that level no more often than slips of 5 % explain
/// (binomial test at 5 %) are unseen: a set that holds none stands for them, and the level is found again.
/// Pairs that are not told from one of their effects likewise, where the evidence is not strongly for them.
/// `unknown` is let in by the same rule at a false-alarm rate of 5 %; intervals of θ likewise at 90 %, those
/// of effects with few runs drawn to what all need; upper limits at 95 %.
///
/// Nothing is learnt from runs whose effect was left out; what becomes of them is counted.
Promise promise_of(const std::vector<Replayed>& replayed, double confidence);

/// Probabilities by tempered evidence, and intervals widened about their means.
std::vector<Hypothesis> corrected(std::vector<Hypothesis> said, const Correction& correction);

/// Of corrected explanations: `unknown` where it passes the gate, alone where it has nineteen twentieths; and
/// the most probable of the others until they hold the level, without the unseen that another one in the set
/// stands for. Pairs that were not run (kOtherPairs) are in it where nothing is more probable.
AmbiguitySet set_of(const std::vector<Hypothesis>& corrected, const Correction& correction);

}  // namespace pendular::diagnosis
