#pragma once

#include <string>

#include "sweep/store.h"

namespace pendular::sweep {

/// Makes one run of a store, from its checkpoint where it was stopped, on as many threads as the program may
/// use; returns at once where it is done, has failed, or another worker that lives makes it. A failure is
/// recorded in the store and thrown; interrupted, the run waits again with its checkpoint kept.
void make_run(Store& store, const std::string& hash);

/// The command that a run's files name as theirs.
std::string run_command(const std::string& hash);

}  // namespace pendular::sweep
