#pragma once

#include "diagnosis/diagnosis.h"

namespace pendular::test {

/// A diagnosis as one of a real experiment may come out: two compressions with an unloading, a coordination
/// number, displacements; as many effects as the library has, all pairs of the first five; repaired runs.
diagnosis::Diagnosis planted_diagnosis();

/// The same with further observations of every kind, for pictures as full as they may get.
diagnosis::Diagnosis crowded_diagnosis();

/// One in which nothing differs, nothing was repaired and hardly anything was measured.
diagnosis::Diagnosis quiet_diagnosis();

/// Every text of it is `text`, some numbers are not finite.
diagnosis::Diagnosis named_throughout(const std::string& text);

}  // namespace pendular::test
