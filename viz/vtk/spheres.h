#pragma once

#include <vtkActor.h>
#include <vtkScalarsToColors.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "base/vec3.h"

namespace pendular::viz {

/// Scenes are in mm, so that single precision and the camera's defaults serve.
inline constexpr double kMillimetre = 1e3;

/// Beads with centres and radii in m; coloured by `values`, one of each, where there is a map.
vtkSmartPointer<vtkActor> spheres(const std::vector<Vec3>& centres, const std::vector<double>& radii,
                                  const std::vector<double>& values = {}, vtkScalarsToColors* map = nullptr);

}  // namespace pendular::viz
