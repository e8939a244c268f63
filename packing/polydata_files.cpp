#include "packing/polydata_files.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <mutex>

#include "packing/vtkhdf_file.h"

namespace pendular {
namespace {

/// Keeps what VTK would print.
class QuietWindow : public vtkOutputWindow {
 public:
  static QuietWindow* New();
  vtkTypeMacro(QuietWindow, vtkOutputWindow) void DisplayText(const char* text) override { text_ += text; }
  void DisplayErrorText(const char* text) override { DisplayText(text); }
  void DisplayWarningText(const char* text) override { DisplayText(text); }
  void DisplayGenericWarningText(const char* text) override { DisplayText(text); }
  void DisplayDebugText(const char* text) override { DisplayText(text); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};
vtkStandardNewMacro(QuietWindow);

/// Collects VTK's messages while it lives. The window is VTK's one global, hence the lock.
class VtkMessages {
 public:
  VtkMessages()
      : lock_(mutex()),
        before_(vtkOutputWindow::GetInstance()),
        logged_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~VtkMessages() {
    vtkLogger::SetStderrVerbosity(logged_);
    vtkOutputWindow::SetInstance(before_);
  }
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;
  bool any() const { return !window_->text().empty(); }

 private:
  static std::mutex& mutex() {
    static std::mutex only;
    return only;
  }
  std::lock_guard<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity logged_;
  vtkNew<QuietWindow> window_;
};

vtkSmartPointer<vtkDataArray> to_vtk(const std::vector<double>& values) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkDataArray> to_vtk(const std::vector<std::int64_t>& values) {
  auto array = vtkSmartPointer<vtkTypeInt64Array>::New();
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkDataArray> to_vtk(const std::vector<Vec3>& values) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  for (std::size_t k = 0; k < values.size(); ++k)
    array->SetTuple(static_cast<vtkIdType>(k), values[k].data());
  return array;
}

void add_arrays(vtkFieldData* data, const std::vector<std::pair<std::string, PolyTable::Array>>& arrays,
                std::size_t length) {
  for (const auto& [name, values] : arrays) {
    auto array = std::visit([](const auto& v) { return to_vtk(v); }, values);
    if (static_cast<std::size_t>(array->GetNumberOfTuples()) != length)
      throw std::logic_error("write_polydata: array " + name + " has the wrong length");
    array->SetName(name.c_str());
    data->AddArray(array);
  }
}

void add_fields(vtkFieldData* data, const PolyTable& table) {
  for (const auto& [name, text] : table.text_fields) {
    vtkNew<vtkStringArray> array;
    array->SetName(name.c_str());
    array->InsertNextValue(text);
    data->AddArray(array);
  }
  for (const auto& [name, number] : table.number_fields) {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name.c_str());
    array->InsertNextValue(number);
    data->AddArray(array);
  }
}

vtkSmartPointer<vtkPolyData> to_vtk(const PolyTable& table) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetData(to_vtk(table.points));
  data->SetPoints(points);
  vtkNew<vtkCellArray> lines;
  for (const auto& [i, j] : table.lines) {
    const vtkIdType ends[2] = {i, j};
    lines->InsertNextCell(2, ends);
  }
  data->SetLines(lines);
  add_arrays(data->GetPointData(), table.point_data, table.points.size());
  add_arrays(data->GetCellData(), table.line_data, table.lines.size());
  add_fields(data->GetFieldData(), table);
  return data;
}

bool write(const fs::path& path, const PolyTable& table) {
  const auto data = to_vtk(table);
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->SetFileName(path.c_str());
  writer->SetDataModeToAppended();
  writer->SetCompressorTypeToZLib();
  writer->SetHeaderTypeToUInt64();
  return writer->Write() == 1 && !messages.any();
}

}  // namespace
}  // namespace pendular

const pendular::PolydataFiles pendular_polydata_files = {pendular::write, pendular::write_vtkhdf_file};
