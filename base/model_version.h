#pragma once

namespace pendular {

/// What equal requests give equal results by: part of the hashes of stores, blind splits and checkpoints.
/// Raise it with every change of what a simulation computes from one sample; tests/effects/model_version_test
/// says when.
inline constexpr int kModelVersion = 2;

}  // namespace pendular
