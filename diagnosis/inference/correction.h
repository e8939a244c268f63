#pragma once

#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/inference/evidence.h"

namespace pendular::diagnosis {

inline constexpr const char *kNone = "none", *kUnknown = "unknown";

/// |θ| from which on an effect is told from none, at either sign: infinite where it is at no magnitude, zero
/// where nothing was learnt.
struct ToldFrom {
  double negative = 0.0, positive = 0.0;

  bool tells(double theta) const { return theta < 0.0 ? -theta >= negative : theta >= positive; }
};

/// By how much intervals of θ are widened about their means.
struct Widening {
  std::map<std::string, double> own = {};  ///< of an effect
  double others = 2.0;

  double of(const std::string& effect) const {
    const auto found = own.find(effect);
    return found == own.end() ? others : found->second;
  }
  friend bool operator==(const Widening&, const Widening&) = default;
};

/// How probabilities, sets and intervals are made to hold what they promise, learnt from a replay; as it
/// stands, for a bank that is too small for one: wide.
struct Correction {
  double temperature = 2.0;           ///< by which logarithms of evidence are divided
  double temperature_of_pairs = 2.0;  ///< likewise, what a pair's has beyond the best of plainer()
  /// Of what observations show that no effect of the library brings about, odds of `unknown` to all others.
  double odds_by_itself = 0.0;
  std::vector<double> misfits = {};  ///< χ² that none or one effect leaves in replayed runs, ascending
  Misfit misfit = {};                ///< the odds of `unknown` by them
  double level = 0.95;               ///< of the known explanations' probability, that a set holds
  std::map<std::string, double> levels = {};  ///< likewise, for explanations that need another one to get in
  double gate = 0.1;                          ///< P(unknown) from which it is in the set
  Widening widening = {};                     ///< of intervals of θ
  Widening of_all = {};                       ///< likewise, to hold the magnitudes of all replayed runs
  double widening_of_limits = 2.0;            ///< of upper limits of |θ|, beside the latter
  std::map<std::string, ToldFrom> told_from = {};  ///< of effects; one that is not in it, at any magnitude
  std::set<std::string> untold_pairs = {};         ///< that are not told from none or an effect of theirs

  /// Whether an effect of this magnitude is told from none.
  bool tells(const std::string& effect, double theta) const {
    const auto from = told_from.find(effect);
    return from == told_from.end() || from->second.tells(theta);
  }
};

/// What a set of explanations is made of.
struct AmbiguitySet {
  std::vector<std::string> ids;  ///< best first
  double probability = 0.0;
};

/// Upper limit of |θ|, at 95 %, of a corrected single effect that is there: the farther end of an interval
/// that holds the magnitudes of all replayed runs, widened.
double upper_limit(const Hypothesis& effect, const Correction& correction);

/// Probabilities by tempered evidence, and intervals widened about their means. Pairs that were not run are
/// one explanation, kOtherPairs. Where misfits were learnt, `unknown` is judged by them: beside an
/// explanation that leaves more than all but a share q of replayed runs it has odds (Misfit). What an
/// unmodelled mechanism does is often done by two effects, but seldom by one: so it is one effect's residual
/// that tells.
std::vector<Hypothesis> corrected(std::vector<Hypothesis> said, const Correction& correction);

/// Why `unknown` is in the set of corrected explanations, as a clause; null where it is not. It is where it
/// is the most probable, and where it passes the gate.
const char* why_unknown(const std::vector<Hypothesis>& corrected, const Correction& correction);

/// Of corrected explanations: `unknown` (why_unknown()), and the most probable of the others until they hold
/// the level, without those that another one stands for (stand_in()) and, where `unknown` is the most
/// probable, those below a hundredth. Pairs that were not run (kOtherPairs) are in it where nothing is more
/// probable.
AmbiguitySet set_of(const std::vector<Hypothesis>& corrected, const Correction& correction);

/// What stands in a set for an explanation that is not told from it at its mean magnitudes: none, where it is
/// ten times as probable, for an effect; the most probable of not_told_from() for a pair, if that is more
/// probable and the pair's evidence not ten times as large. Null where nothing does.
const Hypothesis* stand_in(const Hypothesis& h, const std::vector<Hypothesis>& corrected,
                           const Correction& correction);

/// The member of a set of corrected explanations that stands for one outside it; null where none does.
const Hypothesis* stands_for(const Hypothesis& h, const AmbiguitySet& set,
                             const std::vector<Hypothesis>& corrected, const Correction& correction);

/// The explanation of this name; null where there is none.
const Hypothesis* said_of(const std::vector<Hypothesis>& said, const std::string& id);

/// Whether a set holds an explanation.
bool holds(const AmbiguitySet& set, const std::string& id);

/// What may stand for an explanation that is not told from it: none for an effect; its effects and none for a
/// pair.
std::vector<std::string> plainer(const std::string& id);

/// Explanations that one with these magnitudes is not told from: none for an effect that is too small to be;
/// for a pair with one such effect the other effect, for an untold pair and one with two all plainer ones.
std::vector<std::string> not_told_from(const std::string& id, const std::map<std::string, double>& magnitudes,
                                       const Correction& correction);

/// What a pair's evidence has, as a logarithm, beyond the best of what may stand for it.
double beyond_plainer(const Hypothesis& pair, const std::vector<Hypothesis>& said);

/// χ² that the most probable of none and single effects leaves.
double left_by_plain(const std::vector<Hypothesis>& said);

}  // namespace pendular::diagnosis
