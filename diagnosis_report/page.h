#pragma once

#include <vector>

#include "diagnosis/diagnosis.h"
#include "viz/report.h"

namespace pendular::diagnosis_report {

/// The pictures of a report by the section they belong to.
struct Pictures {
  std::vector<viz::ReportPicture> where, overlays, which, how_far, next;
};

/// The page: the verdict and the figures it rests on, then pictures and tables.
viz::Report page_of(const diagnosis::Diagnosis& diagnosis, const Pictures& pictures);

}  // namespace pendular::diagnosis_report
