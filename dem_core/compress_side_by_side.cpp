#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/interrupt.h"
#include "dem_core/compression.h"
#include "dem_core/step/side_by_side.h"

namespace pendular::dem_core {
namespace {

static_assert(kMostSideBySide == kRuns);

/// A task that has a lane.
struct Member {
  std::size_t task;
  std::unique_ptr<Compression> compression;

  Simulation* simulation() const { return &compression->state().simulation; }
};

bool can_be_stepped(const Member& member) {
  return member.compression->task().sample.compression.control != Control::relaxation &&
         !member.compression->state().finished;
}

/// Whether a further one can be made beside these.
bool suits(const std::vector<Member>& members, const Member& further) {
  if (members.empty()) return true;
  std::vector<Simulation*> simulations;
  for (const Member& member : members) simulations.push_back(member.simulation());
  simulations.push_back(further.simulation());
  return can_be_stepped(members.front()) && can_be_stepped(further) && SideBySide::suits(simulations);
}

/// Advances all until each has ended.
class Tests {
 public:
  Tests(std::vector<Member>& members, const CompressEnded& ended)
      : all_(simulations_of(members)), members_(members), ended_(ended), going_(members.size(), true) {
    runs_.reserve(members.size());
    for (std::size_t k = 0; k < members.size(); ++k) {
      runs_.emplace_back(all_, k);
      tests_.push_back(members[k].compression->test(runs_[k]));
    }
  }

  void make() {
    while (std::find(going_.begin(), going_.end(), true) != going_.end()) {
      for_going([&](std::size_t k) { return begin_step(k); });
      all_.step();
      for_going([&](std::size_t k) { return end_step(k); });
      if (!interrupted()) continue;
      for_going([&](std::size_t k) { return keep(k); });
      throw Interrupted("interrupted; the runs go on from where they are");
    }
  }

 private:
  static std::vector<Simulation*> simulations_of(const std::vector<Member>& members) {
    std::vector<Simulation*> simulations;
    for (const Member& member : members) simulations.push_back(member.simulation());
    return simulations;
  }

  /// Calls f(k) for each that goes on. One ends by what this returns or throws.
  template <typename Function>
  void for_going(const Function& f) {
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (!going_[k]) continue;
      std::optional<CompressOutcome> outcome;
      try {
        outcome = f(k);
      } catch (...) {
        outcome = {std::nullopt, std::current_exception()};
      }
      if (outcome) end(k, *outcome);
    }
  }

  std::optional<CompressOutcome> begin_step(std::size_t k) {
    tests_[k].before_step();
    return std::nullopt;
  }

  std::optional<CompressOutcome> end_step(std::size_t k) {
    Compression& compression = *members_[k].compression;
    tests_[k].after_step();
    const bool finished = compression.state().finished;
    if (finished || (compression.state().open_row.steps == 0 && compression.checkpoint_due())) keep(k);
    if (!finished) return std::nullopt;
    return CompressOutcome{
        compression.result(compression.performance(seconds_each(), tests_[k].output_seconds())), {}};
  }

  std::optional<CompressOutcome> keep(std::size_t k) {
    tests_[k].store();
    members_[k].compression->keep();
    return std::nullopt;
  }

  void end(std::size_t k, const CompressOutcome& outcome) {
    seconds_before_ = seconds_each();
    since_ = Clock::now();
    going_[k] = false;
    all_.stop(k);
    ended_(members_[k].task, outcome);
  }

  /// Of wall time, the part of a test that has gone on until now.
  double seconds_each() const {
    const auto going = std::count(going_.begin(), going_.end(), true);
    return seconds_before_ + seconds_since(since_) / static_cast<double>(std::max<std::ptrdiff_t>(1, going));
  }

  SideBySide all_;
  std::vector<Member>& members_;
  const CompressEnded& ended_;
  std::vector<SideBySide::Run> runs_;
  std::vector<Test> tests_;
  std::vector<bool> going_;
  double seconds_before_ = 0.0;
  Clock::time_point since_ = Clock::now();
};

}  // namespace

void compress_side_by_side(std::span<const CompressTask> tasks, const CompressEnded& ended) {
  std::vector<Member> members;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    try {
      Member member = {k, std::make_unique<Compression>(tasks[k])};
      if (suits(members, member)) members.push_back(std::move(member));
    } catch (const Error&) {
      ended(k, {std::nullopt, std::current_exception()});
    }
  }
  if (members.size() > 1) {
    Tests(members, ended).make();
  } else if (members.size() == 1) {
    const std::size_t first = members.front().task;
    CompressOutcome outcome;
    try {
      outcome.result = compress(tasks[first]);
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      outcome.error = std::current_exception();
    }
    ended(first, outcome);
  }
}

}  // namespace pendular::dem_core
