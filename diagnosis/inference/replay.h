#pragma once

#include <string>
#include <vector>

#include "diagnosis/bank/design.h"
#include "diagnosis/inference/comparison.h"

namespace pendular::diagnosis {

/// A run of the bank, diagnosed as if it had been measured.
struct Replayed {
  int member = 0;
  Changes truth;                 ///< its effects, without those that count as absent (Weigher::absent)
  std::vector<Hypothesis> said;  ///< of it by a bank that lacks its member; most probable first
  std::string left_out = {};  ///< the effect that the library lacked too: to be called unknown; empty: none
  bool put_together = false;  ///< a run of one effect, to which the learnt response to another was added
};

/// What is replayed: runs of the bank, or such experiments besides as no run is.
enum class Replays { runs, all };

/// Every run of the bank that goes all the way is an experiment of known truth: its own errors of measurement
/// and of the simulation, and wrong beliefs, are drawn by their covariances, seeded by its place; its member
/// is left out of all that is learnt. Members are replayed in parallel; what comes out does not depend on the
/// number of threads. Pairs are looked for as in a diagnosis, among those of the most probable single effect;
/// a run of a pair that other members were not run with is none of them. `draws`: of each run. Those without
/// an effect, runs of believed inputs and of readings of the law among them, are about as large a share as
/// none is probable a priori (Priors). `unknown` is not weighed: promise_of() judges it by what they leave.
///
/// Replays::all: three runs of each effect, at a third, two thirds and the end of their order by
/// magnitude, are diagnosed once more by a library without the effect, as if it were a mechanism outside the
/// library. Only those that the library would see (Weigher::absent). And pairs: some runs of each member, to
/// which what it would learn of a second effect is added: responses add there and are known, as those of
/// measured pairs are not.
std::vector<Replayed> replay(const Experiment& experiment, const BankPlan& plan, const BankFeatures& features,
                             Priors priors, int draws, Replays what = Replays::runs);

}  // namespace pendular::diagnosis
