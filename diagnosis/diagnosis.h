#pragma once

#include <Eigen/Core>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/provenance.h"
#include "diagnosis/advice/outlook.h"
#include "diagnosis/experiment/conditions.h"
#include "diagnosis/experiment/experiment.h"
#include "diagnosis/inference/calibration.h"
#include "diagnosis/inference/evidence.h"
#include "diagnosis/inference/gap.h"
#include "diagnosis/repair/place.h"

namespace pendular::diagnosis {

/// An explanation as it is reported.
struct Explanation {
  std::string id;  ///< as Hypothesis::id
  double probability = 0.0;
  std::vector<Magnitude> magnitudes;  ///< one per effect
  std::vector<std::string> units;     ///< likewise
  /// At its best magnitudes, χ² over the number of directions that responses span.
  double reduced_chi_squared = 0.0;
  bool excluded = false;
  std::string reason = {};  ///< why it is excluded or cannot be told; empty: nothing to say
};

/// What one group of features says of an effect's magnitude by itself.
struct GroupMagnitude {
  std::string effect, group;  ///< a group is an observation
  Magnitude magnitude;
};

/// How far a believed input is from what was believed, in its standard deviations, under the best
/// explanation; and what it does to the strongest signature.
struct Pull {
  std::string key;
  double sigma = 0.0;   ///< stated, in the key's unit
  double pull = 0.0;    ///< best value less believed one, over sigma
  double spread = 1.0;  ///< posterior standard deviation over sigma
  double impact = 0.0;  ///< root mean square of its response over the features' noise
};

/// A reading of the law that the experiment follows, though the sample states the other.
struct FollowedReading {
  std::string setting;              ///< as a sample states it
  double share = 0.0, error = 0.0;  ///< of what the reading changes: 0 as stated, 1 as the setting; its sd
};

/// A gap before and after something was added to the simulation, in units of its noise (excess()).
struct Shrinkage {
  double before = 0.0, after = 0.0, fraction = 0.0;
  std::pair<double, double> interval_90 = {0, 0};  ///< of the fraction
  std::vector<std::string> observations;
  bool nothing_to_close = false;  ///< the gap before is within the noise: fraction and interval are zero
};

/// An effect that may be there though nothing shows it, and how large it may be (upper_limit()).
struct Unseen {
  std::string effect, unit;
  double limit = 0.0;
};

/// A measurement that could be made next, and what is expected of it.
struct NextExperiment {
  std::string observation;  ///< in words
  std::string why;
  double cost = 1.0;     ///< in units of one compression test
  Outlook outlook = {};  ///< once it is made; without cases where runs are missing
  double gain = 0.0;     ///< expected entropy that it takes off, bits (next_steps())
  std::size_t runs = 0;  ///< simulations that it still lacks, or that failed
};

/// What could be measured next.
struct NextSteps {
  Outlook
      now;  ///< of the experiment as it is, over what is in question; no cases: nothing is, or too few runs
  std::vector<NextExperiment> experiments;  ///< best value for its cost first; those that lack runs last
};

/// One simulated test in the ledger.
struct LedgerRow {
  std::string hash, purpose, status, message;  ///< purpose: "baseline", "missing_bridges 0.1", …
  std::size_t condition = 0;
};

/// Columns of one observation as measured and as simulated, one per realisation.
struct Overlay {
  std::string observation;
  const Kind* kind = compression_kind();
  Columns measured;
  std::vector<Columns> simulated;  ///< as believed
  std::vector<Columns> repaired;   ///< with the best explanation, from fresh runs; empty: none was made
};

/// What a diagnosis comes to. Features are in the order of `gap.rows` everywhere.
struct Diagnosis {
  std::string experiment, verdict;
  std::vector<std::string> warnings;  ///< what the reader must know
  GapTable gap;
  std::vector<NoiseBudget> noise;          ///< per feature
  std::vector<Explanation> explanations;   ///< most probable first; every effect, none, unknown; pairs
  std::vector<std::string> ambiguity_set;  ///< explanations that cannot be told apart here, best one first
  double set_probability = 0.0;
  std::string nearest_signature;  ///< the single effect of least χ², or "none"
  Promise promise;                ///< how far all this holds, from the replay
  std::vector<Unseen>
      unseen;  ///< effects outside the set that none stands for (stand_in()), or nothing shows
  std::string unlike =
      {};                ///< what observations show that no effect brings about, where it lets `unknown` in
  double p_value = 1.0;  ///< of the best explanation's χ² under noise alone
  std::vector<std::string> effects;  ///< rows of `signatures` and `separation`
  Eigen::MatrixXd signatures;        ///< effect × feature at the effect's scale, over the feature's noise
  Eigen::MatrixXd separation;        ///< isolability(), effects × (effects + 1)
  std::vector<GroupMagnitude> groups;
  std::vector<Pull> pulls;
  std::vector<FollowedReading> law;        ///< none where the cause has no name
  std::vector<std::string> law_as_stated;  ///< ids of readings that are the sample's (laws_as_stated())
  /// Observations whose strains are taken as the specimen's own, where the cause is that the machine misreads
  /// them.
  std::vector<std::string> specimen_strains;
  Shrinkage fitted, withheld;
  double retuned = 0.0, wrong = 0.0;  ///< fractions of the withheld gap that the controls close
  std::string wrong_effect;           ///< of that control; empty: none was made
  NextSteps next;
  std::vector<LedgerRow> ledger;
  std::vector<Overlay> overlays;
  std::vector<Place> places;  ///< where in the specimens scans differ
  Provenance provenance;
};

}  // namespace pendular::diagnosis
