#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "blind/split.h"

namespace pendular::blind {

/// The truth of a case, from its sealed file.
struct Truth {
  std::string name;
  Stratum stratum = Stratum::none;
  std::string answer;                                   ///< right_answer()
  std::vector<std::pair<std::string, double>> effects;  ///< of the library, with θ
  std::string mechanism;                                ///< outside of it; empty: none
  double mechanism_theta = 0.0;
  std::string law, wrong_belief;  ///< the law or engine; the value believed farthest off, in its stratum
  std::size_t packing = 1;
  bool hidden = false;  ///< its effect is too small to be seen
  Observed observed = Observed::curve;
};

/// An explanation as diagnosis.json gives it.
struct Claim {
  double probability = 0.0;
  std::optional<double> magnitude;
  std::optional<std::pair<double, double>> interval_90;
};

/// What a diagnosis promised of cases like it, from its replay.
struct Promised {
  double in_set = 0.0, set_size = 0.0, theta_held = 0.0, false_alarms = 0.0;
};

/// What was said of one case.
struct Diagnosed {
  std::map<std::string, Claim> claims;  ///< by id; pairs "a+b" with a before b in the alphabet
  std::vector<std::string> set;         ///< the ambiguity set, likewise
  std::optional<double> withheld, retuned, wrong_effect;  ///< fractions of the withheld gap closed
  std::optional<double> closable;  ///< fraction that the true effects close (measure_oracles())
  std::optional<std::string> nearest_signature;
  std::optional<Promised> promised;
  std::optional<double> promised_of_none;  ///< share of replayed runs without an effect whose set is right
  std::optional<double> promised_flagged;  ///< of runs whose effect was left out of the library
  std::optional<double> promised_pairs;    ///< in the set, of pairs that were put together
  /// A replayed run of one effect: whether the set holds it, and whether it is the most probable (reports of
  /// earlier versions do not say that).
  struct Run {
    double magnitude;
    std::optional<bool> in_set, first;
  };
  std::map<std::string, std::vector<Run>> replayed;  ///< by effect
  std::map<std::string, double> limits;  ///< upper limits of |θ| of effects that are hardly shown
  /// Of each effect, |θ| from which on the replay tells it from none, below zero and above.
  std::map<std::string, std::pair<double, double>> told_from;
  /// Squared distance of each effect at its usual magnitude from the nearest that another can do, and from
  /// "none".
  std::map<std::string, std::map<std::string, double>> squared_distance;
};

/// A case, what was right to say of it, and what was said; nothing where its diagnosis is missing or cannot
/// be read, and why.
struct Verdict {
  Truth truth;
  std::string answer;  ///< that counts as right: of the truth, or "unknown" where its effects were left out
  std::optional<Diagnosed> said;
  std::string failure;

  std::string top() const;  ///< the most probable explanation; empty where nothing was said
  double probability(const std::string& id) const;
  bool in_set(const std::string& id) const;
  /// Whether the report says that so much of an effect is not told from none.
  bool untold(const std::string& effect, double theta) const;
  /// What a replay promises of a set: that it holds the answer, or none where the one true effect is untold.
  bool set_is_right() const;
  /// How often, by the replay, the answer is in the set where the truth is what it is: nothing, or one effect
  /// of nearly its magnitude and of its sign. Nothing where no such run was replayed.
  std::optional<double> promised_in_set() const;
  /// How often, by the same runs, one effect is the most probable.
  std::optional<double> promised_first() const;
  /// How often, by the replay, a mechanism outside the library is flagged; nothing where the truth is none.
  std::optional<double> promised_flagged() const;
  /// How often, by the replay, a pair of effects is in the set; nothing where the truth is none.
  std::optional<double> promised_pairs() const;
  bool exact() const { return said && top() == answer; }
  bool confidently_wrong() const { return said && !exact() && probability(top()) > 0.9; }
};

/// The file in the report of a case that has what its true effects close.
inline constexpr const char* kOracle = "oracle.json";

/// Both halves of a pair in alphabetical order.
std::string in_order(const std::string& id);

/// Whether the reports of a folder were made with the true effects deleted from the library; the file that
/// says so.
bool without_truth(const fs::path& reports);
void mark_without_truth(const fs::path& reports);

/// The truth of each case that DIR/seals.csv lists. BadInput naming the case whose sealed file is missing or
/// has not the published hash.
std::vector<Truth> open_seals(const fs::path& folder);

/// The truth of one case; BadInput for what is none.
Truth read_truth(const fs::path& sealed);

/// What REPORTS/NAME/diagnosis.json says; BadInput where a key of docs/diagnose.md is missing.
Diagnosed read_diagnosis(const fs::path& path);

/// Truths beside the reports. Where the true effects were left out only cases that have some count.
std::vector<Verdict> verdicts(const std::vector<Truth>& truths, const fs::path& reports);

}  // namespace pendular::blind
