#pragma once

#include "base/process.h"
#include "blind/case_folder.h"

namespace pendular::blind {

/// Makes the cases of a split that are not there yet, each in a process of its own, `cores` side by side, and
/// writes seals.csv when all are there. `command_of` gives what makes one. ComputationFailed naming cases
/// that could not be made.
void make_split(const CaseFolders& folders, const Split& split, std::size_t cores,
                const std::function<Command(std::size_t number)>& command_of);

/// What make_split would do, in words.
std::string work_ahead(const CaseFolders& folders, const Split& split, std::size_t cores);

}  // namespace pendular::blind
