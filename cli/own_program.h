#pragma once

#include "base/files.h"

namespace pendular::cli {

/// `pendular`, for processes of its own: the program that runs now or, where that is `pendular-pictures`, the
/// one beside it.
fs::path own_program();

}  // namespace pendular::cli
