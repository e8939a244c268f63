#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sweep/store.h"

namespace pendular::sweep {

/// Of each request that the store has not finished: the shortest finished run that differs from it in its
/// last strain alone and goes farther. Up to the request's last strain that run is the one asked for, row by
/// row. No run answers a request that keeps all.
std::vector<std::optional<std::string>> longer_runs(Store& store, std::span<const RunRequest> requests);

}  // namespace pendular::sweep
