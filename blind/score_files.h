#pragma once

#include "base/provenance.h"
#include "blind/scores.h"

namespace pendular::blind {

/// Into a folder: cases.csv, a row per case; score.json; score.md, the scores beside what is aimed at.
void write_scores(const fs::path& folder, const std::vector<Verdict>& verdicts, const Scores& scores,
                  const Provenance& provenance);

}  // namespace pendular::blind
