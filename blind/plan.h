#pragma once

#include <map>
#include <string>
#include <vector>

#include "blind/split.h"

namespace pendular::blind {

/// One case as it is to be made: what is true of it, and what of it is observed.
struct CasePlan {
  std::string name;  ///< tells nothing of the truth
  Stratum stratum = Stratum::none;
  std::size_t packing = 0;                ///< of the split
  std::uint64_t seed = 1;                 ///< of all that is random in it
  std::string salt;                       ///< so that its sealed file cannot be guessed from its hash
  std::map<std::string, double> effects;  ///< of the library
  bool hidden = false;                    ///< its effect is too small to be seen (Split::seen_from)
  std::string mechanism;                  ///< of outside of it; empty: none
  double mechanism_theta = 0.0;
  std::map<std::string, double> offsets;  ///< true less believed value, in its sd, by dotted key
  std::string law = "paper";              ///< that the truth follows: see laws()
  std::string engine;                     ///< that makes it: see engines(); empty: as the diagnosis does
  Observed observed = Observed::curve;
  std::vector<std::string> kinds;                            ///< of observation beside the compressions
  bool bridges_at_rest = false, bridges_under_load = false;  ///< the network was measured in these scans

  bool short_specimen() const { return observed >= Observed::second_specimen; }  ///< whether B is tested
  bool scanned() const { return observed == Observed::scan; }
};

/// The laws that truth may follow, and what they change of the sample.
const std::map<std::string, std::vector<SampleSetting>>& laws();

/// All cases of a split, in the order of their names. A function of the split.
std::vector<CasePlan> plan_of(const Split& split);

/// What the diagnosis of a case is right to say: an effect's id, a pair "a+b" in the library's order, "none",
/// or "unknown".
std::string right_answer(const CasePlan& plan);

}  // namespace pendular::blind
