#pragma once

#include <map>
#include <string>

#include "diagnosis/experiment/conditions.h"
#include "sweep/request.h"

namespace pendular::diagnosis {

/// Members from here on are fresh realisations: the bank has none of them.
inline constexpr int kFirstFresh = 101;

/// The packings of members in a folder, each of which is written and read once.
class MemberPackings {
 public:
  explicit MemberPackings(fs::path folder) : folder_(std::move(folder)) {}

  /// The beads that a member of a condition's ensemble starts from: generated with the member's number as
  /// seed or, where the specimen was measured, its own. Of those, member 1 and fresh ones have them as they
  /// are; the others have centres and diameters moved by their stated standard errors, so that the ensemble
  /// shows what these leave open. Where `changed`, the sample with the run's effects, has effects on how
  /// beads are measured, they are those of which the measurement made these. Written into the folder where
  /// they are measured. BadInput where the beads do not fit the sample.
  sweep::PackingSource of(const Condition& condition, int member, const Sample& changed);

 private:
  fs::path folder_;
  std::map<std::string, sweep::PackingSource> known_;
};

/// Beads in a condition's specimen: measured, or expected of its volume fraction.
double beads_in(const Condition& condition);

}  // namespace pendular::diagnosis
