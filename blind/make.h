#pragma once

#include "blind/case_folder.h"

namespace pendular::blind {

/// Makes the cases of a split that are not there yet, each in a process of its own, `cores` side by side, and
/// writes seals.csv when all are there. The words of that process are given by `words_of`. ComputationFailed
/// naming cases that could not be made.
void make_split(const CaseFolders& folders, const Split& split, std::size_t cores,
                const std::function<std::vector<std::string>(std::size_t number)>& words_of);

/// What make_split would do, in words.
std::string work_ahead(const CaseFolders& folders, const Split& split, std::size_t cores);

}  // namespace pendular::blind
