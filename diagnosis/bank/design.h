#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/bank/emulator.h"
#include "diagnosis/bank/feature_values.h"
#include "diagnosis/bank/field_readings.h"

namespace pendular::diagnosis {

/// A run, and all that was changed in it.
struct KnownRun {
  DesignRun run;
  Changes truth;
};

/// An observation and the runs from which responses to it are learnt, feature by feature.
struct Design {
  ObservedFeatures observed;
  std::vector<DesignRun> runs;
  std::vector<KnownRun> at_fit = {};   ///< at best fits (DesignPoint::at_fit), where no member is left out
  std::vector<Eigen::VectorXd> whole;  ///< as believed, of specimens of the observed size
  Eigen::VectorXd by_noise;  ///< what an error of a fifth in the stated errors of displacements does
};

/// The features of an experiment, and of every run of its bank.
class BankFeatures {
 public:
  BankFeatures(Level level, const Experiment& experiment, const BankPlan& plan,
               const std::vector<SimulatedTests>& tests);

  /// Without the runs of one member, 0: with all. Features that fewer than four of five runs show are left
  /// out, with a word in `warnings` where they are landmarks or a field. BadInput where none is left.
  Design design(std::vector<std::string>& warnings, int but = 0) const;

  /// The design without one member, and the runs of that member that show all of its features, as other
  /// experiments would, each `draws` times, with noise of their own in the fields.
  std::pair<Design, std::vector<KnownRun>> held_out(int member, int draws) const;

  /// Members whose tests go all the way.
  std::vector<int> members() const;

 private:
  struct Learnt;
  Learnt learn(std::vector<std::string>& warnings, int but) const;
  DesignRun run_of(std::size_t point, Eigen::VectorXd values) const;

  ObservedFeatures observed_;                              // without those of fields
  std::vector<Eigen::VectorXd> values_;                    // per point; likewise
  std::vector<std::pair<std::size_t, FieldBank>> fields_;  // by observation
  std::vector<std::string> unread_;                        // observations whose fields are not read
  std::vector<DesignPoint> points_;
  bool scaled_ = false;
  std::string name_;  // of the experiment
};

/// With what instruments would have made of the first baselines that have an effect on nothing but the
/// reading.
std::pair<BankPlan, std::vector<SimulatedTests>> with_readings(const BankPlan& plan,
                                                               const std::vector<SimulatedTests>& tests);

}  // namespace pendular::diagnosis
