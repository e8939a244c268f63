#pragma once

#include <functional>

#include "base/sample.h"

namespace pendular::diagnosis {

/// A sample changed as another specimen of the same kind is. Where the sample states its bonds' stiffness and
/// the change leaves that alone, it follows the polymer and the bridge's geometry by the ratio that finite
/// elements give: a stated stiffness belongs to the bridge that the sample states.
Sample changed_sample(const Sample& sample, const std::function<void(Sample&)>& change);

}  // namespace pendular::diagnosis
