#include "viz/vtk/spheres.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkOpenGLSphereMapper.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>

namespace pendular::viz {

vtkSmartPointer<vtkActor> spheres(const std::vector<Vec3>& centres, const std::vector<double>& radii,
                                  const std::vector<double>& values, vtkScalarsToColors* map) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkFloatArray> radius;
  radius->SetName("radius");
  vtkNew<vtkDoubleArray> value;
  value->SetName("value");
  for (std::size_t k = 0; k < centres.size(); ++k) {
    const Vec3 p = centres[k] * kMillimetre;
    const vtkIdType point = points->InsertNextPoint(p.data());
    cells->InsertNextCell(1, &point);
    radius->InsertNextValue(static_cast<float>(radii[k] * kMillimetre));
    if (map != nullptr) value->InsertNextValue(values[k]);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cells);
  data->GetPointData()->AddArray(radius);
  vtkNew<vtkOpenGLSphereMapper> mapper;
  mapper->SetScaleArray("radius");
  if (map != nullptr) {
    data->GetPointData()->SetScalars(value);
    mapper->SetLookupTable(map);
    mapper->UseLookupTableScalarRangeOn();
  } else {
    mapper->ScalarVisibilityOff();
  }
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.35);
  actor->GetProperty()->SetDiffuse(0.7);
  actor->GetProperty()->SetSpecular(0.0);
  return actor;
}

}  // namespace pendular::viz
