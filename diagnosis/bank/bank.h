#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/experiment/conditions.h"
#include "diagnosis/experiment/specimens.h"
#include "sweep/request.h"

namespace pendular::diagnosis {

/// What is changed in a simulation: magnitudes of effects by their ids, believed inputs by their dotted keys
/// in standard deviations, other readings of the law (LawReading) by theirs with 1.
using Changes = std::map<std::string, double>;

/// A condition's sample with some changes. A believed input that an observation sets itself changes by the
/// same share. Values stop at the ends of the key's range. `size`: the specimen's over the observed one's;
/// effects that are lengths of the specimen's ends scale with it.
Sample changed_condition(const Experiment& experiment, const Condition& condition, const Changes& changes,
                         double size = 1.0);

/// Standard deviations of believed inputs that float: those stated and, where nothing is stated, five per
/// cent of the polymer's modulus and, of specimens whose beads were not measured, 0.01 of volume fraction.
std::map<std::string, double> floating_inputs(const Experiment& experiment);

/// One simulation of all conditions, or of the scans alone.
struct DesignPoint {
  int member = 1;
  std::string id;           ///< of the effect or believed input that is changed, or of a pair; empty: none
  double theta = 0.0;       ///< magnitude, or standard deviations; of a pair, 1: as in its changes
  bool whole = true;        ///< specimens of the observed size; else smaller ones (BankPlan::size)
  std::uint64_t seed = 1;   ///< of what effects draw
  bool scans_only = false;  ///< only tests that end at a scan
  Changes changes = {};
  bool at_fit = false;  ///< as `id` fits best (fitted_points()): no response is learnt from it
};

struct BankOptions {
  int levels = 3;                   ///< magnitudes of each effect that draws; twice as many of the others
  std::set<std::string> leave_out;  ///< effects that are not considered
  int runs = 160;                   ///< most that are made at the leading explanations (leading_points())
};

/// The runs from which responses to effects and believed inputs are learnt.
struct BankPlan {
  struct Run {
    std::size_t point, condition;
  };
  std::vector<Condition> conditions;
  std::vector<double> size;  ///< per condition: of the bank's specimens over the observed one
  std::vector<DesignPoint> points;
  std::vector<Run> runs;  ///< one per request
  std::vector<sweep::RunRequest> requests;
  std::map<std::string, std::string> absent;  ///< effects without runs, and why
  int further = 0;                            ///< runs that may be made at the leading explanations
  std::set<std::string> as_stated;            ///< laws that are known to be the sample's (laws_as_stated())

  /// Whether responses are learnt on smaller specimens.
  bool scaled() const {
    return std::any_of(size.begin(), size.end(), [](double one) { return one != 1.0; });
  }
};

/// Baselines of every member; each effect at sixths of its range (in both directions where it has two, then
/// at quarters; of errors that the tables of beads show by themselves at parts of one and a half of that) and
/// each believed input at one and two standard deviations to both sides, on members in turn; other readings
/// of the law on eight members, or all. Effects that draw are drawn three times at thirds of their range.
/// Tests that end at a scan are short: of them there are four times as many members without an effect, and
/// twice as many draws. Scans see small effects: with one, effects of one sign are run at 0.06 of their
/// range, too. Specimens of more than 2,000 beads that were not measured get a smaller one of the same shape,
/// beside baselines of their own size. Effects that only change what instruments read need no runs. Leaving
/// an effect out changes no other run.
BankPlan plan_bank(const Experiment& experiment, const BankOptions& options, const fs::path& beads_folder);

/// Those changes that a simulation takes: without effects that only change what instruments read.
Changes without_readings(Changes changes);

/// The seed of what effects draw. It does not follow the place of an effect in the list: runs stay those of a
/// shorter or longer library.
std::uint64_t draw_seed(int member, int draw);

/// Adds the runs of further points.
void add_points(const Experiment& experiment, const std::vector<DesignPoint>& points,
                MemberPackings& packings, BankPlan& plan);

/// Of each condition: of the bank's specimens over the observed one.
std::vector<double> sizes_of(const std::vector<Condition>& conditions);

/// The run of one condition with some changes, its specimen of the observed size times `size`; `seed` of what
/// effects draw. What only instruments read is no part of it (read_run()).
sweep::RunRequest request_of(const Experiment& experiment, const Condition& condition, int member,
                             std::uint64_t seed, const Changes& changes, MemberPackings& packings,
                             double size = 1.0);

}  // namespace pendular::diagnosis
