#pragma once

#include <span>
#include <string>

#include "sweep/store.h"

namespace pendular::sweep {

/// Makes one run of a store, from its checkpoint where it was stopped, on as many threads as the program may
/// use; returns at once where it is done, has failed, or another worker that lives makes it. A failure is
/// recorded in the store and thrown; interrupted, the run waits again with its checkpoint kept.
void make_run(Store& store, const std::string& hash);

/// Makes runs side by side in the lanes of a register, on one thread: the first that is to be made, and those
/// of the others that suit it; the rest wait again. The bytes are those of make_run(). A failure is recorded
/// in the store and stops no other run; interrupted, all wait again with their checkpoints kept, and
/// Interrupted is thrown.
void make_side_by_side(Store& store, std::span<const std::string> hashes);

/// The command that a run's files name as theirs.
std::string run_command(const std::string& hash);

}  // namespace pendular::sweep
