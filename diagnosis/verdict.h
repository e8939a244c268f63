#pragma once

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis {

/// The diagnosis in a paragraph that can be acted on: how large the gap is and where, what explains it and
/// what cannot be told apart, how far it shrinks beside the controls, and what to do next.
std::string verdict_of(const Diagnosis& diagnosis);

}  // namespace pendular::diagnosis
