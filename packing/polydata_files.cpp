#include "packing/polydata_files.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
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
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>

#include "base/error.h"

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

/// Tuples [first, first + count) of an array of one or three components; nothing for any other.
std::optional<PolyTable::Array> from_vtk(vtkDataArray* array, vtkIdType first, vtkIdType count) {
  if (array->GetNumberOfComponents() == 3) {
    std::vector<Vec3> values(static_cast<std::size_t>(count));
    for (vtkIdType k = 0; k < count; ++k)
      array->GetTuple(first + k, values[static_cast<std::size_t>(k)].data());
    return values;
  }
  if (array->GetNumberOfComponents() != 1) return std::nullopt;
  if (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE) {
    std::vector<double> values(static_cast<std::size_t>(count));
    for (vtkIdType k = 0; k < count; ++k) values[static_cast<std::size_t>(k)] = array->GetTuple1(first + k);
    return values;
  }
  std::vector<std::int64_t> values(static_cast<std::size_t>(count));
  for (vtkIdType k = 0; k < count; ++k)
    values[static_cast<std::size_t>(k)] = array->GetVariantValue(first + k).ToTypeInt64();
  return values;
}

/// The arrays of points or cells, of which `count` from `first` on belong to the table.
std::vector<std::pair<std::string, PolyTable::Array>> from_vtk(vtkDataSetAttributes* data, vtkIdType expected,
                                                               vtkIdType first, vtkIdType count,
                                                               const fs::path& path) {
  std::vector<std::pair<std::string, PolyTable::Array>> arrays;
  for (int k = 0; k < data->GetNumberOfArrays(); ++k) {
    vtkDataArray* array = data->GetArray(k);
    if (array == nullptr || array->GetName() == nullptr) continue;
    if (array->GetNumberOfTuples() != expected)
      bad_input("{}: array {}: found {} values, expected {}", path.string(), array->GetName(),
                array->GetNumberOfTuples(), expected);
    if (auto values = from_vtk(array, first, count))
      arrays.emplace_back(array->GetName(), std::move(*values));
  }
  return arrays;
}

std::vector<std::array<int, 2>> lines_of(vtkPolyData* data, const fs::path& path) {
  std::vector<std::array<int, 2>> lines;
  vtkNew<vtkIdList> ends;
  vtkCellArray* cells = data->GetLines();
  const vtkIdType points = data->GetNumberOfPoints();
  for (vtkIdType k = 0; k < cells->GetNumberOfCells(); ++k) {
    cells->GetCellAtId(k, ends);
    if (ends->GetNumberOfIds() != 2)
      bad_input("{}: line {}: found {} points, expected 2", path.string(), k, ends->GetNumberOfIds());
    for (vtkIdType end = 0; end < 2; ++end)
      if (ends->GetId(end) < 0 || ends->GetId(end) >= points)
        bad_input("{}: line {}: found point {}, expected one of {} points", path.string(), k,
                  ends->GetId(end), points);
    lines.push_back({static_cast<int>(ends->GetId(0)), static_cast<int>(ends->GetId(1))});
  }
  return lines;
}

void read_fields(vtkFieldData* data, PolyTable& table) {
  for (int k = 0; k < data->GetNumberOfArrays(); ++k) {
    vtkAbstractArray* array = data->GetAbstractArray(k);
    if (array->GetName() == nullptr || array->GetNumberOfValues() != 1) continue;
    if (auto* text = vtkStringArray::SafeDownCast(array))
      table.text_fields[array->GetName()] = text->GetValue(0);
    if (auto* number = vtkDataArray::SafeDownCast(array))
      table.number_fields[array->GetName()] = number->GetTuple1(0);
  }
}

constexpr const char* kEnd = "</VTKFile>";
constexpr const char* kSeal = "<!-- pendular sha256 ";

/// The comment that closes the files written here, so that damage is noticed before VTK's reader meets it: a
/// damaged file can end the program inside the library.
std::string seal(std::string_view content) {
  return kSeal + sha256(content) + " -->\n";
}

/// A file that is cut or, if it was written here, damaged in any way.
void require_whole(const fs::path& path) {
  const std::string bytes = read_text(path);
  const std::size_t end = bytes.rfind(kEnd);
  if (end == std::string::npos)
    bad_input("{}: found no {} at its end, expected a whole VTK XML file (.vtp)", path.string(), kEnd);
  const std::size_t sealed = bytes.rfind(kSeal);
  if (sealed == std::string::npos &&
      bytes.find_first_not_of(" \r\n\t", end + std::strlen(kEnd)) == std::string::npos)
    return;  // of another program
  if (sealed == std::string::npos || bytes.substr(sealed) != seal(std::string_view(bytes).substr(0, sealed)))
    bad_input("{}: found damaged VTK data (its checksum does not match), expected the file as it was written",
              path.string());
}

void write(const fs::path& path, const PolyTable& table) {
  const auto data = to_vtk(table);
  write_atomically(path, [&](const fs::path& temporary) {
    const VtkMessages messages;
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(data);
    writer->SetFileName(temporary.c_str());
    writer->SetDataModeToAppended();
    writer->SetCompressorTypeToZLib();
    writer->SetHeaderTypeToUInt64();
    if (writer->Write() != 1 || messages.any())
      throw ComputationFailed(fmt::format("{}: cannot be written (folder or disc full?)", path.string()));
    std::ofstream out(temporary, std::ios::binary | std::ios::app);
    out << seal(read_text(temporary));
    out.close();
    if (!out) throw ComputationFailed(fmt::format("{}: cannot be written (disc full?)", path.string()));
  });
}

PolyTable read(const fs::path& path) {
  require_whole(path);
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  if (reader->CanReadFile(path.c_str()) == 0)
    bad_input("{}: is no VTK PolyData XML file (.vtp)", path.string());
  try {
    reader->Update();
  } catch (const std::bad_alloc&) {
    bad_input("{}: found arrays too large for the memory, expected an undamaged .vtp", path.string());
  }
  vtkPolyData* data = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || messages.any() || data == nullptr)
    bad_input("{}: found damaged VTK data, expected a readable .vtp", path.string());

  PolyTable table;
  table.points.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (vtkIdType k = 0; k < data->GetNumberOfPoints(); ++k)
    data->GetPoint(k, table.points[static_cast<std::size_t>(k)].data());
  table.lines = lines_of(data, path);
  table.point_data =
      from_vtk(data->GetPointData(), data->GetNumberOfPoints(), 0, data->GetNumberOfPoints(), path);
  table.line_data = from_vtk(data->GetCellData(), data->GetNumberOfCells(), data->GetNumberOfVerts(),
                             data->GetNumberOfLines(), path);
  read_fields(data->GetFieldData(), table);
  return table;
}

}  // namespace
}  // namespace pendular

const pendular::PolydataFiles pendular_polydata_files = {pendular::write, pendular::read};
