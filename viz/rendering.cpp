#include "viz/rendering.h"

#include "base/module.h"

namespace pendular::viz {

const Rendering& rendering() {
  static const auto* found =
      static_cast<const Rendering*>(module_symbol(PENDULAR_RENDERING, "pendular_rendering"));
  return *found;
}

}  // namespace pendular::viz
