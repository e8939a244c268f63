#pragma once

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis {

/// What causes the gap, or that this is not known: the beginning of the verdict, which stands as soon as
/// explanations are judged.
std::string cause_of(const Diagnosis& diagnosis);

/// The diagnosis in three short paragraphs, a line each: what causes the gap, or that this is not known, and
/// what to do next and why; where the gap is and how far it shrinks; how far to trust that.
std::string verdict_of(const Diagnosis& diagnosis);

}  // namespace pendular::diagnosis
