#pragma once

#include <string>

#include "blind/scores.h"

namespace pendular::blind {

/// The scores as a page of tables, in Markdown: what is promised beside what is aimed at, by name and by
/// class, by stratum; and what went wrong.
std::string score_page(const std::vector<Verdict>& verdicts, const Scores& scores);

}  // namespace pendular::blind
