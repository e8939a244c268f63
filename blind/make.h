#pragma once

#include "base/process.h"
#include "blind/case_folder.h"

namespace pendular::blind {

/// Makes the cases of a split that are not there yet, of all its packings or of one (from 1; 0: all), each in
/// a process of its own, `cores` side by side, and writes seals.csv of the cases that are there. Returns how
/// many were asked for. `command_of` gives what makes one. ComputationFailed naming cases that could not be
/// made.
std::size_t make_split(const CaseFolders& folders, const Split& split, std::size_t packing, std::size_t cores,
                       const std::function<Command(std::size_t number)>& command_of);

/// What make_split would do, in words.
std::string work_ahead(const CaseFolders& folders, const Split& split, std::size_t packing,
                       std::size_t cores);

}  // namespace pendular::blind
